// SPDX-License-Identifier: MIT
#include "methods/hmm_mos/threshold.h"

#include <algorithm>

namespace raymoval::hmm_mos_method {
namespace {

/// Voxels by bin. A bin has the scores above its lower edge, up to its upper one; the first has the
/// lowest score as well. Edges are compared in whole numbers.
std::vector<std::int64_t> histogram(const std::vector<ScoreCount>& counts, int bins, int lowest,
                                    int highest) {
  std::vector<std::int64_t> voxels(static_cast<std::size_t>(bins));
  const std::int64_t span = highest - lowest;
  for (const ScoreCount& count : counts) {
    const std::int64_t place = std::int64_t{count.score - lowest} * bins;
    const std::int64_t bin = std::max<std::int64_t>((place + span - 1) / span - 1, 0);
    voxels[static_cast<std::size_t>(bin)] += count.voxels;
  }
  return voxels;
}

}  // namespace

std::optional<double> otsu_threshold(const std::vector<ScoreCount>& counts, int bins) {
  if (counts.empty()) return std::nullopt;
  const auto [low, high] = std::minmax_element(
      counts.begin(), counts.end(),
      [](const ScoreCount& a, const ScoreCount& b) { return a.score < b.score; });
  if (low->score == high->score) return std::nullopt;
  const std::vector<std::int64_t> voxels = histogram(counts, bins, low->score, high->score);
  double all = 0.0, all_sum = 0.0;
  for (int i = 0; i < bins; ++i) {
    all += static_cast<double>(voxels[static_cast<std::size_t>(i)]);
    all_sum += i * static_cast<double>(voxels[static_cast<std::size_t>(i)]);
  }
  double below = 0.0, below_sum = 0.0, best = 0.0;
  int threshold = 0;
  for (int i = 0; i < bins; ++i) {  // What is below bin i against the rest.
    const double above = all - below;
    if (below > 0.0 && above > 0.0) {
      const double difference = below_sum / below - (all_sum - below_sum) / above;
      const double between = below * above * difference * difference;
      if (between >= best) {
        best = between;
        threshold = i;
      }
    }
    below += static_cast<double>(voxels[static_cast<std::size_t>(i)]);
    below_sum += i * static_cast<double>(voxels[static_cast<std::size_t>(i)]);
  }
  return low->score + static_cast<double>(threshold) * (high->score - low->score) / bins;
}

}  // namespace raymoval::hmm_mos_method
