// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "benchmark/picture/canvas/colours.h"
#include "datasets/sequence.h"
#include "eval/points/labelled_voxels.h"

namespace raymoval {

/// What became of a point.
enum class Outcome : std::uint8_t {
  kKeptStatic,
  kTruePositive,   ///< Moving and removed.
  kFalsePositive,  ///< Static and removed.
  kFalseNegative,  ///< Moving and kept.
};
inline constexpr std::size_t kOutcomes = 4;

Colour outcome_colour(Outcome outcome);
/// "moving, removed".
const char* outcome_name(Outcome outcome);
/// In the order of legends.
inline constexpr std::array<Outcome, kOutcomes> kLegendOrder = {
    Outcome::kTruePositive, Outcome::kFalsePositive, Outcome::kFalseNegative, Outcome::kKeptStatic};

constexpr Outcome outcome_of(bool moving, bool removed) {
  if (moving) return removed ? Outcome::kTruePositive : Outcome::kFalseNegative;
  return removed ? Outcome::kFalsePositive : Outcome::kKeptStatic;
}

/// Which points of a sequence are shown: those that protocols evaluate by default, in range, with a
/// label that is not ignored, and not on the sensor's own vehicle (2.7 m about its axis).
class ShownPoints {
 public:
  explicit ShownPoints(const Sequence& sequence)
      : classes_(sequence.label_rule), range_m_(sequence.range_m) {}

  /// @param point in the sensor frame
  [[nodiscard]] bool shows(const Eigen::Vector3f& point, std::uint32_t label) const;
  [[nodiscard]] bool moving(std::uint32_t label) const { return classes_.moving(label); }

 private:
  LabelClasses classes_;
  RangeLimits range_m_;
};

}  // namespace raymoval
