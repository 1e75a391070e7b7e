// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include "core/scan/scan.h"
#include "core/scan/voxel_key.h"

namespace raymoval::raymoval_method {

/// The voxels of a scan's points. Consecutive points often share a voxel; they are one run, so that
/// a voxel is processed once per run and not once per point.
struct VoxelRuns {
  std::vector<VoxelIndex> voxels;    ///< The voxel of each run.
  std::vector<std::uint32_t> first;  ///< The first point of each run, then the number of points.

  [[nodiscard]] std::size_t size() const { return voxels.size(); }
  /// Values by point from values by run.
  template <class Value>
  [[nodiscard]] std::vector<Value> of_points(const std::vector<Value>& of_runs) const {
    std::vector<Value> values;
    values.reserve(first.empty() ? 0 : first.back());
    for (std::size_t run = 0; run < size(); ++run) {
      values.insert(values.end(), first[run + 1] - first[run], of_runs[run]);
    }
    return values;
  }

  /// The results of one thread for a part of the scan, kept for their memory.
  struct Part {
    std::vector<VoxelIndex> of_points, of_runs;
    std::vector<std::uint32_t> first;
  };
  std::vector<Part> parts;
};

/// Finds the voxel of each point in the world lattice. Runs also end every few thousand points, at
/// places that depend only on the number of points.
/// @param runs replaced; its memory is used again
/// @throws DataError as `voxel_index`
void find_voxels(const Scan& scan, double inverse_voxel_size, int threads, VoxelRuns& runs);

/// Calls `visit(point)` for each point of a mask that is 1, of which there are few.
template <class Visit>
void for_each_set(const Mask& mask, Visit&& visit) {
  const std::uint8_t* const end = mask.data() + mask.size();
  for (const std::uint8_t* at = mask.data(); at != end; ++at) {
    at = static_cast<const std::uint8_t*>(std::memchr(at, 1, static_cast<std::size_t>(end - at)));
    if (at == nullptr) return;
    visit(static_cast<std::size_t>(at - mask.data()));
  }
}

/// 1 for each run whose points all have a 1 in `points`.
Mask runs_within(const VoxelRuns& runs, const Mask& points);

}  // namespace raymoval::raymoval_method
