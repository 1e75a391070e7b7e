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

}  // namespace raymoval
