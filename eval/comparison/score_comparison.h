// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "eval/comparison/compare.h"

namespace raymoval {

/// Whether it is known which direction of a rate is better. Other rates are shown in a comparison
/// and decide nothing.
bool has_known_direction(const std::string& rate);

/// Compares the scores of one cell by one protocol on both sides, which are comparable.
/// @param cell of the run
/// @param score has its cell, protocol and what differs across; gets rates, counts and the change
/// @return the changes in words; empty if there are none
std::string compare_scores(const ComparedCell& cell, const ComparedScore& run,
                           const ComparedScore& reference, const ComparisonOptions& options,
                           ScoreComparison& score);

}  // namespace raymoval
