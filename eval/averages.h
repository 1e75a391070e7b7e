// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace raymoval {

/// 2 a b / (a + b), and 0 if both are 0. For PR and RR as fractions it is F1, for SA and DA it is
/// HA.
double harmonic_mean(double a, double b);

/// The square root of a b.
double geometric_mean(double a, double b);

/// F1 as a fraction from PR and RR in percent. It is a harmonic mean of two recalls and not the F1
/// of precision and recall.
double f1_from_percent(double preservation_rate, double rejection_rate);

/// A mean over the segments that have a value, and the number of these segments.
struct Mean {
  std::optional<double> value;  ///< Nothing without any segment.
  std::size_t segments = 0;
};

/// The values of a rate on each segment. A segment on which the rate is undefined has none.
using SegmentValues = std::vector<std::optional<double>>;

/// The mean of the present values.
Mean mean_of(const SegmentValues& values);

/// `combine` of the means of two rates over the segments that have both.
/// @param first,second values of the same segments
Mean combined_means(const SegmentValues& first, const SegmentValues& second,
                    double (*combine)(double, double));

}  // namespace raymoval
