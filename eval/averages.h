// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace raymoval {

/// Rates of one segment; PR and RR in percent, F1 a fraction; no value where undefined.
struct SegmentRates {
  std::optional<double> PR;
  std::optional<double> RR;
  std::optional<double> F1;
};

/// A mean over the segments that have the value, and how many those are.
struct Mean {
  std::optional<double> value;  ///< None without any segment.
  std::size_t segments = 0;
};

/// Averages over segments. Each mean leaves out the segments where its own rate is undefined.
struct AverageRates {
  Mean PR, RR;
  Mean mean_F1;  ///< Mean of the segments' F1: what papers print.
  /// F1 of the mean PR and the mean RR of the segments that have both.
  Mean F1_of_means;
  std::size_t segments = 0;  ///< All of them, undefined ones included.
};

AverageRates average_rates(const std::vector<SegmentRates>& segments);

/// Mean of the values that are there.
Mean mean_of(const std::vector<std::optional<double>>& values);

}  // namespace raymoval
