// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "benchmark/result/results.h"
#include "benchmark/tables/table_options.h"
#include "benchmark/tables/text_table.h"

namespace raymoval {

/// The PR-RR curve (or SA-DA) of each sweep by each protocol: a row for each point, named by its
/// parameters, a block for each sequence and one of their means, the best F1 (or HA) of each
/// marked.
std::vector<TextTable> sweep_tables(const RunResults& results, const TableOptions& options = {});

}  // namespace raymoval
