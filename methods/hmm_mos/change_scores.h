// SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <utility>
#include <vector>

#include "methods/hmm_mos/belief_map.h"

namespace raymoval::hmm_mos_method {

/// Scores of voxels. What is not listed has 0.
using Scores = VoxelMap<int>;

/// Calls `visit(neighbour)` with the 26 neighbours of a voxel and the voxel itself.
template <class Visit>
void for_neighbourhood(const VoxelIndex& voxel, Visit&& visit) {
  for (int i = 0; i < 27; ++i) {
    visit(VoxelIndex(voxel.x() + i / 9 - 1, voxel.y() + i / 3 % 3 - 1, voxel.z() + i % 3 - 1));
  }
}

/// Step 6: for each occupied voxel the voxels around it that appeared with this scan, less those of
/// unknown state, where that is above 0.
Scores change_scores(const ScanGrid& now, const BeliefMap& map, int reach);

/// Step 7: each occupied voxel gets the median score of the occupied voxels among its 26 neighbours
/// and itself.
Scores median_scores(const ScanGrid& now, const Scores& scores);

/// Step 8: the sums of the scores of the last scans.
class ScoreWindow {
 public:
  explicit ScoreWindow(int scans) : scans_(static_cast<std::size_t>(scans)) {}

  void add(Scores scores);
  [[nodiscard]] const Scores& sums() const { return sums_; }
  [[nodiscard]] int sum(VoxelKey voxel) const {
    const auto found = sums_.find(voxel);
    return found == sums_.end() ? 0 : found->second;
  }

 private:
  std::size_t scans_;
  std::deque<Scores> last_;
  Scores sums_;
};

}  // namespace raymoval::hmm_mos_method
