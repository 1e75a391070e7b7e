// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "eval/rate.h"

namespace raymoval::dynamicmap {

/// SA, DA, AA and HA, the rates of both variants of the protocol.
std::vector<RateSpec> accuracy_rate_list();

/// SA = present / static, DA = gone / dynamic, AA = sqrt(SA DA), HA = 2 SA DA / (SA + DA), all in
/// percent. SA or DA is undefined if its class is empty, and AA and HA are with it.
/// @param unit what is counted, "point" or "voxel"
std::vector<Rate> accuracy_rates(std::int64_t present_static, std::int64_t static_count,
                                 std::int64_t removed_dynamic, std::int64_t dynamic_count,
                                 const std::string& unit);

/// The counts of a result: the names of `specs` with their values, in the same order.
std::vector<std::pair<std::string, std::int64_t>> named_counts(
    const std::vector<CountSpec>& specs, const std::vector<std::int64_t>& values);

}  // namespace raymoval::dynamicmap
