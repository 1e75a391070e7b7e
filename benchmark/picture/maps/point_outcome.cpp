// SPDX-License-Identifier: MIT
#include "benchmark/picture/maps/point_outcome.h"

#include "eval/columns/removal_tally.h"

namespace raymoval {

Colour outcome_colour(Outcome outcome) {
  switch (outcome) {
    case Outcome::kTruePositive:
      return verdict_colours::kTruePositive;
    case Outcome::kFalsePositive:
      return verdict_colours::kFalsePositive;
    case Outcome::kFalseNegative:
      return verdict_colours::kFalseNegative;
    case Outcome::kKeptStatic:
      break;
  }
  return verdict_colours::kKeptStatic;
}

const char* outcome_name(Outcome outcome) {
  switch (outcome) {
    case Outcome::kTruePositive:
      return "moving, removed";
    case Outcome::kFalsePositive:
      return "static, removed";
    case Outcome::kFalseNegative:
      return "moving, kept";
    case Outcome::kKeptStatic:
      break;
  }
  return "static, kept";
}

bool ShownPoints::shows(const Eigen::Vector3f& point, std::uint32_t label) const {
  const Eigen::Vector3d metres = point.cast<double>();
  return classes_.of(label) != LabelClass::kIgnored && range_m_.contains(metres.norm()) &&
         metres.head<2>().norm() >= kMinimumHorizontalRange;
}

}  // namespace raymoval
