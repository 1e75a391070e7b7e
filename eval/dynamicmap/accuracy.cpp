// SPDX-License-Identifier: MIT
#include "eval/dynamicmap/accuracy.h"

#include "eval/averages.h"

namespace raymoval::dynamicmap {

std::vector<RateSpec> accuracy_rate_list() {
  // The oracle keeps every static point, so SA is 100. Its loss of dynamic points near static
  // points depends on the data.
  return {{.name = "SA",
           .role = RateRole::kKept,
           .nothing_removed = 100.0,
           .everything_removed = 0.0,
           .moving_points_removed = 100.0},
          {.name = "DA",
           .role = RateRole::kRemoved,
           .nothing_removed = 0.0,
           .everything_removed = 100.0},
          {.name = "AA",
           .role = RateRole::kMean,
           .formula = RateFormula{"SA", "DA", "geometric_mean", geometric_mean},
           .note = "AA is the geometric and HA the harmonic mean of SA and DA."},
          {.name = "HA",
           .role = RateRole::kHeadline,
           .formula = RateFormula{"SA", "DA", "harmonic_mean", harmonic_mean}}};
}

std::vector<Rate> accuracy_rates(std::int64_t present_static, std::int64_t static_count,
                                 std::int64_t removed_dynamic, std::int64_t dynamic_count,
                                 const std::string& unit) {
  const Rate SA =
      percent_rate("SA", present_static, static_count, "the ground truth has no static " + unit);
  const Rate DA =
      percent_rate("DA", removed_dynamic, dynamic_count, "the ground truth has no dynamic " + unit);
  const std::string& reason = SA.value ? DA.undefined_reason : SA.undefined_reason;
  Rate AA{"AA", std::nullopt, reason};
  Rate HA{"HA", std::nullopt, reason};
  if (SA.value && DA.value) {
    AA.value = geometric_mean(*SA.value, *DA.value);
    HA.value = harmonic_mean(*SA.value, *DA.value);
  }
  return {SA, DA, AA, HA};
}

std::vector<std::pair<std::string, std::int64_t>> named_counts(
    const std::vector<CountSpec>& specs, const std::vector<std::int64_t>& values) {
  std::vector<std::pair<std::string, std::int64_t>> counts;
  for (std::size_t i = 0; i < specs.size(); ++i) counts.emplace_back(specs[i].name, values.at(i));
  return counts;
}

}  // namespace raymoval::dynamicmap
