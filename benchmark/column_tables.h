// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "benchmark/results.h"
#include "benchmark/text_table.h"

namespace raymoval {

/// One table of what the removed points were, a row for each method: precision, recall, residue,
/// preservation, the mover that stays most and the static class that is lost most (of those with
/// `kNamedClassPoints` points or more). Counts are added up over sequences. None without columns.
std::vector<TextTable> compact_column_tables(const RunResults& results);

inline constexpr std::int64_t kNamedClassPoints = 100;

/// Every column of every method, then the intervals of every rate.
std::vector<TextTable> full_column_tables(const RunResults& results);

/// Where the order of the methods depends on the protocol: for each sequence, and for the mean over
/// all, the rank of each method by the F1 or HA of each protocol, and how far it moves from the
/// first protocol to the one where it moves most. What is displayed alike has the same rank. None
/// for fewer than two protocols or methods.
std::vector<TextTable> ranking_tables(const RunResults& results);

}  // namespace raymoval
