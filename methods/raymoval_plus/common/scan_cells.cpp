// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/common/scan_cells.h"

#include <atomic>

#include "core/parallel.h"
#include "methods/raymoval_plus/common/point_kernels.h"

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
  kernels::PointsToCells whole;
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(whole.rotation.data()) =
      scan.T_world_sensor.linear();
  Eigen::Map<Eigen::Vector3d>(whole.translation.data()) = scan.T_world_sensor.translation();
  Eigen::Map<Eigen::Vector3d>(whole.cells_a_metre.data()) = cells_a_metre;
  whole.limit = kVoxelLimit;
  const kernels::PointKernels kernels = kernels::best_point_kernels();
  std::atomic<bool> inside = true;
  parallel_chunks(threads, points, kPointsATask, [&](std::size_t begin, std::size_t end) {
    kernels::PointsToCells job = whole;
    job.points = scan.points[begin].data();
    job.count = end - begin;
    const kernels::PointCells to{cells.x.data() + begin, cells.y.data() + begin,
                                 cells.z.data() + begin, cells.parts.data() + begin,
                                 with_height ? cells.height.data() + begin : nullptr};
    if (!kernels.find_cells(job, to)) inside = false;
  });
  if (!inside) throw_outside(scan, cells_a_metre);
}

}  // namespace raymoval::raymoval_plus_method
