// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace raymoval {

enum class RateUnit { kPercent, kFraction };

/// What a rate says of an answer.
enum class RateRole {
  kKept,      ///< How much of what stands is kept.
  kRemoved,   ///< How much of what moves is removed.
  kHeadline,  ///< Both in one number; methods are ranked by it.
  kMean,      ///< Another mean of both.
  kSecondary  ///< A rate of a part of the points; shown where it is asked for.
};

/// What a rate is. Tables, charts and logs read it here.
struct RateSpec {
  std::string name;
  RateUnit unit = RateUnit::kPercent;
  int decimals = 3;
  bool higher_is_better = true;
  RateRole role = RateRole::kSecondary;

  /// The value of a perfect answer: 100 or 1.
  [[nodiscard]] double full() const { return unit == RateUnit::kPercent ? 100.0 : 1.0; }
};

/// The rates that are shown without being asked for, in the order in which they are shown.
const std::vector<RateSpec>& rate_specs();

/// Whether `rate_spec` knows what the rate called `name` is.
bool is_known_rate(const std::string& name);

/// What the rate called `name` is. One that is not in `rate_specs()` is secondary; it has unit and
/// decimals of the rate that its name begins with ("F1_no_truck": those of F1), else it is a
/// percentage.
RateSpec rate_spec(const std::string& name);

}  // namespace raymoval
