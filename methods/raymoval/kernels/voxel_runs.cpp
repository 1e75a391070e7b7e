// SPDX-License-Identifier: MIT
#include "methods/raymoval/kernels/voxel_runs.h"

#include <algorithm>
#include <array>

#include "core/parallel.h"
#include "methods/raymoval/kernels/scan_kernels.h"

namespace raymoval::raymoval_method {
namespace {

constexpr std::size_t kPart = 8192;   ///< Points of a part.
constexpr std::size_t kPiece = 1024;  ///< Points whose voxels are held at a time.

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

/// The voxels of the points begin .. end - 1, into `voxels` from its begin.
void find_piece(const Scan& scan, kernels::Voxelisation job, std::size_t begin, std::size_t end,
                VoxelIndex* voxels) {
  const kernels::Kernels kernel = kernels::best_kernels();
  const auto single = [&](std::size_t k) {
    voxels[k - begin] =
        voxel_index(scan.T_world_sensor * scan.points[k].cast<double>(), job.inverse_voxel_size);
  };
  const std::size_t whole = (end - begin) / kernel.lanes * kernel.lanes;
  job.points += 3 * begin;
  job.voxels = voxels->data();
  const bool on_lattice = kernel.voxelise(job, 0, whole);
  // If one of them is beyond the lattice, its error says where.
  for (std::size_t k = on_lattice ? begin + whole : begin; k < end; ++k) single(k);
}

/// Appends the runs of `voxels`, which begin with point `begin`.
void append_runs(const VoxelIndex* voxels, std::size_t count, std::size_t begin,
                 VoxelRuns::Part& part) {
  std::size_t runs = part.count;
  VoxelIndex last = runs == 0 ? VoxelIndex(voxels[0].array() + 1) : part.voxels[runs - 1];
  for (std::size_t k = 0; k < count; ++k) {
    // Without a branch, which could not be foretold: what begins no run is written over.
    const VoxelIndex here = voxels[k];
    part.voxels[runs] = here;
    part.first[runs] = static_cast<std::uint32_t>(begin + k);
    const int differs = (here.x() ^ last.x()) | (here.y() ^ last.y()) | (here.z() ^ last.z());
    runs += differs != 0 ? 1 : 0;
    last = here;
  }
  part.count = runs;
}

void find_part(const Scan& scan, const kernels::Voxelisation& job, std::size_t begin,
               std::size_t end, VoxelRuns::Part& part) {
  part.voxels.resize(kPart);
  part.first.resize(kPart);
  part.count = 0;
  std::array<VoxelIndex, kPiece> voxels;
  for (std::size_t piece = begin; piece < end; piece += kPiece) {
    const std::size_t last = std::min(piece + kPiece, end);
    find_piece(scan, job, piece, last, voxels.data());
    append_runs(voxels.data(), last - piece, piece, part);
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
    const auto count = static_cast<std::ptrdiff_t>(part.count);
    runs.voxels.insert(runs.voxels.end(), part.voxels.begin(), part.voxels.begin() + count);
    runs.first.insert(runs.first.end(), part.first.begin(), part.first.begin() + count);
  }
  runs.first.push_back(static_cast<std::uint32_t>(scan.size()));
}

Mask runs_within(const VoxelRuns& runs, const Mask& points) {
  Mask within(runs.size(), 0);
  std::size_t run = 0, left = 0;  // Points of the run that were not seen in the mask yet.
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
