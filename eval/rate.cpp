// SPDX-License-Identifier: MIT
#include "eval/rate.h"

#include <algorithm>

namespace raymoval {

const std::vector<RateSpec>& rate_specs() {
  static const std::vector<RateSpec> specs = {
      {"PR", RateUnit::kPercent, 3, true, RateRole::kKept},
      {"RR", RateUnit::kPercent, 3, true, RateRole::kRemoved},
      {"F1", RateUnit::kFraction, 4, true, RateRole::kHeadline},
      {"SA", RateUnit::kPercent, 3, true, RateRole::kKept},
      {"DA", RateUnit::kPercent, 3, true, RateRole::kRemoved},
      {"AA", RateUnit::kPercent, 3, true, RateRole::kMean},
      {"HA", RateUnit::kPercent, 3, true, RateRole::kHeadline}};
  return specs;
}

bool is_known_rate(const std::string& name) {
  return std::any_of(rate_specs().begin(), rate_specs().end(), [&](const RateSpec& spec) {
    return name == spec.name || name.starts_with(spec.name + "_");
  });
}

RateSpec rate_spec(const std::string& name) {
  for (const RateSpec& spec : rate_specs()) {
    if (spec.name == name) return spec;
  }
  for (RateSpec spec : rate_specs()) {
    if (!name.starts_with(spec.name + "_")) continue;
    spec.name = name;
    spec.role = RateRole::kSecondary;
    return spec;
  }
  RateSpec unknown;
  unknown.name = name;
  return unknown;
}

}  // namespace raymoval
