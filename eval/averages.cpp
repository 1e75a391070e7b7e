// SPDX-License-Identifier: MIT
#include "eval/averages.h"

#include "eval/rates.h"

namespace raymoval {
namespace {

Mean f1_of_means(const std::vector<SegmentRates>& segments) {
  std::vector<std::optional<double>> preservation, rejection;
  for (const SegmentRates& segment : segments) {
    if (!segment.PR || !segment.RR) continue;
    preservation.push_back(segment.PR);
    rejection.push_back(segment.RR);
  }
  if (preservation.empty()) return {};
  return {f1_from_percent(*mean_of(preservation).value, *mean_of(rejection).value),
          preservation.size()};
}

}  // namespace

Mean mean_of(const std::vector<std::optional<double>>& values) {
  Mean mean;
  double sum = 0.0;
  for (const std::optional<double>& value : values) {
    if (!value) continue;
    sum += *value;
    ++mean.segments;
  }
  if (mean.segments > 0) mean.value = sum / static_cast<double>(mean.segments);
  return mean;
}

AverageRates average_rates(const std::vector<SegmentRates>& segments) {
  std::vector<std::optional<double>> preservation, rejection, f1;
  for (const SegmentRates& segment : segments) {
    preservation.push_back(segment.PR);
    rejection.push_back(segment.RR);
    f1.push_back(segment.F1);
  }
  return {mean_of(preservation), mean_of(rejection), mean_of(f1), f1_of_means(segments),
          segments.size()};
}

}  // namespace raymoval
