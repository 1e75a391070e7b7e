// SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "methods/hmm_mos/belief_map.h"

namespace raymoval::hmm_mos_method {

/// Scores of voxels. Missing voxels have score 0.
using Scores = VoxelMap<int>;

/// Step 6: for each occupied voxel, the number of voxels around it that appeared in this scan,
/// minus those of unknown state, if this is above 0.
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

/// The number of voxels with a score.
struct ScoreCount {
  int score = 0;
  std::int64_t voxels = 0;
};

/// Step 9: the bin edge of a histogram that best separates higher scores from the rest (Otsu 1979);
/// the highest of several equally good edges.
/// @param counts each score once, in any order
/// @return no value if all scores are equal, or there are none
std::optional<double> otsu_threshold(const std::vector<ScoreCount>& counts, int bins);

/// Steps 6 to 12: the moving voxels of each scan, from changes in this scan and the scans just
/// before.
class MovingVoxels {
 public:
  explicit MovingVoxels(const Parameters& parameters)
      : parameters_(parameters), window_(parameters.window_scans) {}

  /// Adds the next scan.
  /// @param map that has observed the scan
  void add(const ScanGrid& now, const BeliefMap& map);

  /// The moving voxels of the last scan that was added; none if the scan is static as a whole.
  [[nodiscard]] const VoxelSet& found() const { return is_static_ ? none_ : dynamic_; }

 private:
  void find_dynamic(const ScanGrid& now);
  /// The counts of the window's scores over the voxels that are occupied now, including voxels
  /// without a score.
  [[nodiscard]] std::vector<ScoreCount> count_scores(const ScanGrid& now) const;

  Parameters parameters_;
  ScoreWindow window_;
  int scans_ = 0;
  VoxelSet dynamic_;
  bool is_static_ = true;
  VoxelSet none_;
};

}  // namespace raymoval::hmm_mos_method
