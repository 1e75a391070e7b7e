// SPDX-License-Identifier: MIT
#include "eval/rate.h"

namespace raymoval {

std::optional<double> RateSpec::expected(KnownAnswer answer) const {
  switch (answer) {
    case KnownAnswer::kNothingRemoved:
      return nothing_removed;
    case KnownAnswer::kEverythingRemoved:
      return everything_removed;
    default:
      return moving_points_removed;
  }
}

Rate percent_rate(const std::string& name, std::int64_t part, std::int64_t whole,
                  const std::string& reason) {
  if (whole == 0) return {name, std::nullopt, reason};
  return {name, 100.0 * static_cast<double>(part) / static_cast<double>(whole)};
}

}  // namespace raymoval
