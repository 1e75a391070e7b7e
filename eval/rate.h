// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace raymoval {

enum class RateUnit { kPercent, kFraction };

/// The role of a rate.
enum class RateRole {
  kKept,      ///< Share of static points that are kept, or lost if lower is better.
  kRemoved,   ///< Share of moving points that are removed, or left if lower is better.
  kHeadline,  ///< Both in one number. Methods are ranked by it.
  kMean,      ///< Another mean of both.
  kSecondary  ///< A rate of a part of the points. It is shown only on request.
};

/// An answer whose rates are known before it is scored.
enum class KnownAnswer { kNothingRemoved, kEverythingRemoved, kMovingPointsRemoved };

/// How a rate follows from two others.
struct RateFormula {
  std::string first, second;  ///< Names of the two rates.
  std::string rule;           ///< Name of the rule: "harmonic_mean".
  double (*combine)(double, double) = nullptr;
  /// Whether tables also show `combine` of the means of the two rates, as "F1_of_means". This
  /// number differs from the mean of the combined rates.
  bool shown_of_means = false;

  bool operator==(const RateFormula&) const = default;
};

/// The definition of a rate, for tables, charts, comparisons and logs.
struct RateSpec {
  std::string name;
  RateUnit unit = RateUnit::kPercent;
  int decimals = 3;
  bool higher_is_better = true;
  RateRole role = RateRole::kSecondary;
  /// What the rate must be for each known answer. It has no value if that depends on the data.
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

/// The definition of a count.
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
