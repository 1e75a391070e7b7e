// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "eval/comparison/compare.h"

namespace raymoval {

/// Whether more of a rate is known to be better. Of other rates nothing is known: they are told and
/// not judged.
bool higher_is_better(std::string_view rate);

/// Compares what one protocol says of one cell on both sides, which are comparable.
/// @param score has cell, protocol and what differs across; gets rates, counts and the change
/// @return what moved, in words; empty if nothing did
std::string judge_score(const ComparedCell& cell, const ComparedScore& run,
                        const ComparedScore& reference, const ComparisonOptions& options,
                        ScoreComparison& score);

}  // namespace raymoval
