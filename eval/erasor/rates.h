// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "eval/erasor/matching.h"
#include "eval/protocol.h"

namespace raymoval::erasor {

/// What the names of counts and rates end with where trucks are counted as static.
inline constexpr const char* kNoTruck = "_no_truck";

/// PR, RR and F1, then the same with trucks counted as static.
std::vector<RateSpec> rate_list();

/// All counts that a result may have.
std::vector<CountSpec> count_list();

/// PR, RR and F1 of `counts`. @param suffix stands behind their names
std::vector<Rate> rates_of(const MatchCounts& counts, const std::string& suffix = "");

/// Adds `counts` and their rates to a result. @param suffix stands behind their names
void add_matches(const MatchCounts& counts, const std::string& suffix, ProtocolResult& result);

/// Intervals of PR, RR and F1. @param scans the counts of each scan, in order
Intervals intervals_of(const std::vector<MatchCounts>& scans);

}  // namespace raymoval::erasor
