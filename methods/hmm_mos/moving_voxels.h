// SPDX-License-Identifier: MIT
#pragma once

#include "methods/hmm_mos/change_scores.h"
#include "methods/hmm_mos/threshold.h"

namespace raymoval::hmm_mos_method {

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
