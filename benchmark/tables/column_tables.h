// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "benchmark/result/results.h"
#include "benchmark/tables/table_options.h"
#include "benchmark/tables/text_table.h"

namespace raymoval {

/// One table of what the removed points were, a row for each method: precision, recall, residue,
/// preservation, the mover that stays most and the static class that is lost most (of those with
/// `kNamedClassPoints` points or more). Counts are added up over sequences. None without columns.
std::vector<TextTable> compact_column_tables(const RunResults& results);

inline constexpr std::int64_t kNamedClassPoints = 100;

/// What methods are worth by points: precision, recall, residue, rejection and preservation; then
/// rejection and preservation by range and by height, a row for each method, a block for all points
/// and for each class; then the intervals of every rate.
std::vector<TextTable> full_column_tables(const RunResults& results);

/// Where the order of the methods depends on the protocol: the rank of each method by the F1 or HA
/// of each protocol, and how far it moves from the first protocol to the one where it moves most.
/// What is displayed alike has the same rank. Ranks are by the mean over the sequences; with
/// `options.disagreements` also by each sequence, and each pair that changes places is named. None
/// for fewer than two protocols or methods.
std::vector<TextTable> ranking_tables(const RunResults& results, const TableOptions& options = {});

}  // namespace raymoval
