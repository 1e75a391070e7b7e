// SPDX-License-Identifier: MIT
#include "methods/raymoval/consistency.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace raymoval::raymoval_method {

Mask check_consistency(const ProjectedScan& scan, const std::vector<float>& map_reference,
                       const RangeMargin& margin, int threads) {
  Mask dynamic(scan.range.size(), 0);
  parallel_for(threads, dynamic.size(), 8192, [&](std::size_t k) {
    if (scan.bin[k] < 0) return;
    const float reference = map_reference[static_cast<std::size_t>(scan.bin[k])];
    const float range = scan.range[k];
    dynamic[k] = reference != kNoRange && reference - range > margin.at(range) ? 1 : 0;
  });
  return dynamic;
}

double grazing_distance(double vertical, double height, double limit) {
  return std::min(limit, height / std::max(std::abs(vertical), 1e-9));
}

std::vector<SeenThrough> find_seen_through(const ProjectedScan& scan,
                                           const BinWindow& neighbourhood,
                                           const FirstHitImage& first_hit,
                                           const std::vector<float>& map_reference,
                                           const RangeMargin& margin, int threads) {
  constexpr std::size_t kGrain = 8192;
  const std::size_t bins = scan.minimum_range.size();
  std::vector<std::vector<SeenThrough>> parts((bins + kGrain - 1) / kGrain);
  parallel_for(threads, bins, kGrain, [&](std::size_t bin) {
    const double first = first_hit.range[bin], reference = map_reference[bin];
    const auto is_behind = [&](double seen_to) {
      return seen_to - reference > margin.at(reference) && seen_to - first > margin.tau0;
    };
    // The bin's own return first: the nearest return of the neighbourhood is not farther.
    const float own = scan.minimum_range[bin];
    if (own == kNoRange || first == kNoRange || !is_behind(own)) return;
    const float nearest =
        windowed_minimum(scan.minimum_range, neighbourhood, static_cast<int>(bin));
    if (is_behind(nearest)) parts[bin / kGrain].push_back({static_cast<int>(bin), nearest});
  });
  std::vector<SeenThrough> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace raymoval::raymoval_method
