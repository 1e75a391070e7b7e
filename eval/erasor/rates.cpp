// SPDX-License-Identifier: MIT
#include "eval/erasor/rates.h"

#include "eval/averages.h"

namespace raymoval::erasor {

std::vector<RateSpec> rate_list() {
  const RateFormula f1{"PR", "RR", "harmonic_mean", f1_from_percent, true};
  // How many static voxels the oracle loses beside moving ones depends on the data.
  std::vector<RateSpec> rates = {
      {.name = "PR", .role = RateRole::kKept, .nothing_removed = 100.0, .everything_removed = 0.0},
      {.name = "RR",
       .role = RateRole::kRemoved,
       .nothing_removed = 0.0,
       .everything_removed = 100.0,
       .moving_points_removed = 100.0},
      {.name = "F1",
       .unit = RateUnit::kFraction,
       .decimals = 4,
       .role = RateRole::kHeadline,
       .formula = f1}};
  for (std::size_t i = 0; i < 3; ++i) {
    rates.push_back(
        {.name = rates[i].name + kNoTruck, .unit = rates[i].unit, .decimals = rates[i].decimals});
  }
  return rates;
}

std::vector<CountSpec> count_list() {
  std::vector<CountSpec> counts;
  for (const std::string suffix : {"", kNoTruck}) {
    counts.insert(counts.end(), {{"static_voxels" + suffix, true},
                                 {"dynamic_voxels" + suffix, true},
                                 {"preserved_static" + suffix},
                                 {"remaining_dynamic" + suffix}});
  }
  counts.insert(counts.end(), {{"estimate_voxels"},
                               {"estimate_voxels_without_partner"},
                               {"mixed_label_ties", true},
                               {"estimate_mixed_label_ties"},
                               {"unlabelled_voxels", true},
                               {"evaluated_points", true},
                               {"removed_points"},
                               {"out_of_range_points", true},
                               {"ignored_points", true},
                               {"cropped_points", true},
                               {"cloud_points"}});
  return counts;
}

std::vector<Rate> rates_of(const MatchCounts& counts, const std::string& suffix) {
  const Rate preservation =
      percent_rate("PR" + suffix, counts.preserved_static, counts.static_voxels,
                   "the ground truth has no static voxel");
  const Rate rejection =
      percent_rate("RR" + suffix, counts.dynamic_voxels - counts.remaining_dynamic,
                   counts.dynamic_voxels, "the ground truth has no dynamic voxel");
  Rate f1{"F1" + suffix, std::nullopt};
  if (preservation.value && rejection.value) {
    f1.value = f1_from_percent(*preservation.value, *rejection.value);
  } else {
    f1.undefined_reason =
        preservation.value ? rejection.undefined_reason : preservation.undefined_reason;
  }
  return {preservation, rejection, f1};
}

void add_matches(const MatchCounts& counts, const std::string& suffix, ProtocolResult& result) {
  result.counts.emplace_back("static_voxels" + suffix, counts.static_voxels);
  result.counts.emplace_back("dynamic_voxels" + suffix, counts.dynamic_voxels);
  result.counts.emplace_back("preserved_static" + suffix, counts.preserved_static);
  result.counts.emplace_back("remaining_dynamic" + suffix, counts.remaining_dynamic);
  for (Rate& rate : rates_of(counts, suffix)) result.rates.push_back(std::move(rate));
}

Intervals intervals_of(const std::vector<MatchCounts>& scans) {
  std::vector<std::vector<std::int64_t>> counts;
  for (const MatchCounts& scan : scans) {
    counts.push_back(
        {scan.static_voxels, scan.dynamic_voxels, scan.preserved_static, scan.remaining_dynamic});
  }
  return bootstrap(counts, [](const std::vector<std::int64_t>& sums) {
    return rates_of({sums[0], sums[1], sums[2], sums[3]});
  });
}

}  // namespace raymoval::erasor
