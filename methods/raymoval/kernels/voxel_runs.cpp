// SPDX-License-Identifier: MIT
#include "methods/raymoval/kernels/voxel_runs.h"

#include <algorithm>

#include "core/parallel.h"
#include "methods/raymoval/kernels/scan_kernels.h"

namespace raymoval::raymoval_method {
namespace {

constexpr std::size_t kPart = 8192;  ///< Points of a part.

kernels::Voxelisation voxelisation_of(const Scan& scan, double inverse_voxel_size) {
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  static_assert(sizeof(VoxelIndex) == 3 * sizeof(std::int32_t));
  kernels::Voxelisation job;
  job.points = scan.points.front().data();
  for (int row = 0; row < 3; ++row) {
    const auto at = static_cast<std::size_t>(row);
    job.translation[at] = scan.T_world_sensor.translation()[row];
    for (int column = 0; column < 3; ++column) {
      job.rotation[3 * at + static_cast<std::size_t>(column)] =
          scan.T_world_sensor.linear()(row, column);
    }
  }
  job.inverse_voxel_size = inverse_voxel_size;
  job.limit = kVoxelLimit;
  return job;
}

/// Finds the voxels of the points begin .. end - 1 and the runs among them.
void find_part(const Scan& scan, kernels::Voxelisation job, std::size_t begin, std::size_t end,
               VoxelRuns::Part& part) {
  const kernels::ScanKernels kernel = kernels::best_scan_kernels();
  const std::size_t count = end - begin, whole = count / kernel.lanes * kernel.lanes;
  part.of_points.resize(count);
  job.points += 3 * begin;
  job.voxels = part.of_points.front().data();
  const bool on_lattice = kernel.voxelise(job, 0, whole);
  // If one of them is beyond the lattice, this throws the error with its position.
  for (std::size_t k = on_lattice ? whole : 0; k < count; ++k) {
    const Eigen::Vector3d world = scan.T_world_sensor * scan.points[begin + k].cast<double>();
    part.of_points[k] = voxel_index(world, job.inverse_voxel_size);
  }
  part.of_runs.clear();
  part.first.clear();
  for (std::size_t k = 0; k < count; ++k) {
    const VoxelIndex& voxel = part.of_points[k];
    if (k > 0 && voxel == part.of_points[k - 1]) continue;
    part.of_runs.push_back(voxel);
    part.first.push_back(static_cast<std::uint32_t>(begin + k));
  }
}

}  // namespace

void find_voxels(const Scan& scan, double inverse_voxel_size, int threads, VoxelRuns& runs) {
  runs.voxels.clear();
  runs.first.clear();
  const std::size_t parts = (scan.size() + kPart - 1) / kPart;
  if (runs.parts.size() < parts) runs.parts.resize(parts);
  if (parts > 0) {
    const kernels::Voxelisation job = voxelisation_of(scan, inverse_voxel_size);
    parallel_chunks(threads, scan.size(), kPart, [&](std::size_t begin, std::size_t end) {
      find_part(scan, job, begin, end, runs.parts[begin / kPart]);
    });
  }
  for (std::size_t p = 0; p < parts; ++p) {
    const VoxelRuns::Part& part = runs.parts[p];
    runs.voxels.insert(runs.voxels.end(), part.of_runs.begin(), part.of_runs.end());
    runs.first.insert(runs.first.end(), part.first.begin(), part.first.end());
  }
  runs.first.push_back(static_cast<std::uint32_t>(scan.size()));
}

Mask runs_within(const VoxelRuns& runs, const Mask& points) {
  Mask within(runs.size(), 0);
  std::size_t run = 0, left = 0;  // Points of the run that are not yet found in the mask.
  for_each_set(points, [&](std::size_t k) {
    if (k >= runs.first[run + 1] || left == 0) {
      const auto next = std::upper_bound(runs.first.begin(), runs.first.end(), k);
      run = static_cast<std::size_t>(next - runs.first.begin()) - 1;
      left = runs.first[run + 1] - runs.first[run];
    }
    within[run] = --left == 0 ? 1 : 0;
  });
  return within;
}

}  // namespace raymoval::raymoval_method
