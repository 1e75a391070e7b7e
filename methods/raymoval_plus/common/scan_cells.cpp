// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/common/scan_cells.h"

#include <atomic>

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
  std::atomic<bool> inside = true;
  parallel_chunks(threads, points, kPointsATask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Eigen::Vector3d world = scan.T_world_sensor * scan.points[k].cast<double>();
      const Eigen::Array3d in_cells = world.cwiseProduct(cells_a_metre), cell = in_cells.floor();
      if (!(cell.abs() <= kVoxelLimit).all()) {
        inside = false;
        return;
      }
      const Eigen::Array3i parts = ((in_cells - cell) * 256.0).min(255.0).cast<int>();
      const Eigen::Array3i number = cell.cast<int>();
      cells.x[k] = number.x();
      cells.y[k] = number.y();
      cells.z[k] = number.z();
      cells.parts[k] = static_cast<std::uint32_t>(parts.x() | parts.y() << 8 | parts.z() << 16);
      if (with_height) cells.height[k] = static_cast<float>(world.z());
    }
  });
  if (!inside) throw_outside(scan, cells_a_metre);
}

}  // namespace raymoval::raymoval_plus_method
