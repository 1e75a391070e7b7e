// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace raymoval::hmm_mos_method {

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

}  // namespace raymoval::hmm_mos_method
