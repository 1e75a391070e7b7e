// SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "methods/hmm_mos/belief_map.h"

namespace raymoval::hmm_mos_method {

/// Scores of voxels. What is not listed has 0.
using Scores = VoxelMap<int>;

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

/// How many voxels have a score.
struct ScoreCount {
  int score = 0;
  std::int64_t voxels = 0;
};

/// Step 9: the score that parts best what is above it from the rest (Otsu 1979), of those between
/// bins of a histogram. Of several that part equally well it is the highest.
/// @param counts each score once, in any order
/// @return nothing if all scores are equal, or there are none
std::optional<double> otsu_threshold(const std::vector<ScoreCount>& counts, int bins);

/// Steps 6 to 12: which occupied voxels of each scan move, by what changed with it and with the
/// scans just before.
class MovingVoxels {
 public:
  explicit MovingVoxels(const Parameters& parameters)
      : parameters_(parameters), window_(parameters.window_scans) {}

  /// Takes the next scan in.
  /// @param map that has observed the scan
  void add(const ScanGrid& now, const BeliefMap& map);

  /// The moving voxels of the last scan that was added; none if the scan is static as a whole.
  [[nodiscard]] const VoxelSet& found() const { return is_static_ ? none_ : dynamic_; }

 private:
  void find_dynamic(const ScanGrid& now);
  /// The scores of the window at the voxels that are occupied now, those without one included.
  [[nodiscard]] std::vector<ScoreCount> count_scores(const ScanGrid& now) const;

  Parameters parameters_;
  ScoreWindow window_;
  int scans_ = 0;
  VoxelSet dynamic_;
  bool is_static_ = true;
  VoxelSet none_;
};

}  // namespace raymoval::hmm_mos_method
