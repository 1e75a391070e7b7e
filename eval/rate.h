// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace raymoval {

enum class RateUnit { kPercent, kFraction };

/// What a rate says of an answer.
enum class RateRole {
  kKept,      ///< How much of what stands is kept, or lost if lower is better.
  kRemoved,   ///< How much of what moves is removed, or left if lower is better.
  kHeadline,  ///< Both in one number. Methods are ranked by it.
  kMean,      ///< Another mean of both.
  kSecondary  ///< A rate of a part of the points. It is shown only where it is asked for.
};

/// An answer whose rates are known before it is scored.
enum class KnownAnswer { kNothingRemoved, kEverythingRemoved, kMovingPointsRemoved };

/// How a rate follows from two others.
struct RateFormula {
  std::string first, second;  ///< Names of the two rates.
  std::string rule;           ///< What it is called: "harmonic_mean".
  double (*combine)(double, double) = nullptr;
  /// Whether tables also show what `combine` gives for the means of the two rates, as
  /// "F1_of_means". It is another number than the mean of the combined rates.
  bool shown_of_means = false;

  bool operator==(const RateFormula&) const = default;
};

/// What a rate is. Tables, charts, comparisons and logs read it here.
struct RateSpec {
  std::string name;
  RateUnit unit = RateUnit::kPercent;
  int decimals = 3;
  bool higher_is_better = true;
  RateRole role = RateRole::kSecondary;
  /// What the rate must be for each known answer. It has no value where that depends on the data.
  std::optional<double> nothing_removed = {}, everything_removed = {}, moving_points_removed = {};
  std::optional<RateFormula> formula = {};
  std::string note = {};  ///< A sentence that explains the rate below a table, if it needs one.

  /// The largest value: 100 or 1.
  [[nodiscard]] double largest() const { return unit == RateUnit::kPercent ? 100.0 : 1.0; }
  /// The value of a perfect answer.
  [[nodiscard]] double best() const { return higher_is_better ? largest() : 0.0; }
  [[nodiscard]] bool is_better(double a, double b) const {
    return higher_is_better ? a > b : a < b;
  }
  [[nodiscard]] std::optional<double> expected(KnownAnswer answer) const;

  bool operator==(const RateSpec&) const = default;
};

/// What a count is.
struct CountSpec {
  std::string name;
  /// Whether the count follows from scans and labels, so that no mask can change it.
  bool of_truth = false;

  bool operator==(const CountSpec&) const = default;
};

/// The value of a rate, in its unit.
struct Rate {
  std::string name;
  std::optional<double> value;  ///< Nothing if the rate is undefined.
  std::string undefined_reason = "";
};

/// 100 part / whole as a rate. It is undefined for `reason` if `whole` is 0.
Rate percent_rate(const std::string& name, std::int64_t part, std::int64_t whole,
                  const std::string& reason);

}  // namespace raymoval
