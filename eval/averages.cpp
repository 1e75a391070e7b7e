// SPDX-License-Identifier: MIT
#include "eval/averages.h"

#include <cmath>

namespace raymoval {

double harmonic_mean(double a, double b) {
  return a + b > 0.0 ? 2.0 * a * b / (a + b) : 0.0;
}

double geometric_mean(double a, double b) {
  return std::sqrt(a * b);
}

double f1_from_percent(double preservation_rate, double rejection_rate) {
  return harmonic_mean(preservation_rate / 100.0, rejection_rate / 100.0);
}

Mean mean_of(const SegmentValues& values) {
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

Mean combined_means(const SegmentValues& first, const SegmentValues& second,
                    double (*combine)(double, double)) {
  SegmentValues both_first, both_second;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (!first[i] || !second[i]) continue;
    both_first.push_back(first[i]);
    both_second.push_back(second[i]);
  }
  if (both_first.empty()) return {};
  return {combine(*mean_of(both_first).value, *mean_of(both_second).value), both_first.size()};
}

}  // namespace raymoval
