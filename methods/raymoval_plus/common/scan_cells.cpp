// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/common/scan_cells.h"

#include <algorithm>
#include <array>
#include <atomic>

#include "core/floor.h"
#include "core/parallel.h"

namespace raymoval::raymoval_plus_method {
namespace {

/// Throws the error of the first point that is not in the lattice.
void throw_outside(const Scan& scan, const Eigen::Vector3d& cells_a_metre) {
  for (const Eigen::Vector3f& point : scan.points) {
    const Eigen::Vector3d world = scan.T_world_sensor * point.cast<double>();
    if ((cells_a_metre.array() == cells_a_metre.x()).all()) {
      voxel_index(world, cells_a_metre.x());
    } else {
      voxel_index(world.cwiseProduct(cells_a_metre), 1.0);
    }
  }
}

}  // namespace

void find_cells(const Scan& scan, const Eigen::Vector3d& cells_a_metre, BesideCells beside,
                int threads, ScanCells& cells) {
  const std::size_t points = scan.size();
  for (auto* const axis : {&cells.x, &cells.y, &cells.z}) axis->resize(points);
  const bool with_height = beside == BesideCells::kPartsAndHeight;
  cells.parts.resize(points);
  if (with_height) cells.height.resize(points);
  const Eigen::Matrix3d R_world_sensor = scan.T_world_sensor.linear();
  const Eigen::Vector3d position = scan.T_world_sensor.translation();
  const std::array<std::int32_t*, 3> cell = {cells.x.data(), cells.y.data(), cells.z.data()};
  std::atomic<bool> inside = true;
  parallel_chunks(threads, points, kPointsATask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const double x = scan.points[k].x(), y = scan.points[k].y(), z = scan.points[k].z();
      std::uint32_t parts = 0;
      double world = 0.0;
      for (int axis = 0; axis < 3; ++axis) {
        world = R_world_sensor(axis, 0) * x + R_world_sensor(axis, 1) * y +
                R_world_sensor(axis, 2) * z + position[axis];
        const double in_cells = world * cells_a_metre[axis];
        if (!(in_cells >= -kVoxelLimit && in_cells < kVoxelLimit + 1.0)) {
          inside = false;
          return;
        }
        const std::int32_t number = floor_of(in_cells);
        const auto part = static_cast<std::uint32_t>((in_cells - number) * 256.0);
        cell[static_cast<std::size_t>(axis)][k] = number;
        parts |= std::min(part, 255U) << (8 * axis);
      }
      cells.parts[k] = parts;
      if (with_height) cells.height[k] = static_cast<float>(world);
    }
  });
  if (!inside) throw_outside(scan, cells_a_metre);
}

}  // namespace raymoval::raymoval_plus_method
