// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "benchmark/result/results.h"
#include "benchmark/tables/table_options.h"
#include "benchmark/tables/text_table.h"

namespace raymoval {

/// The tables of a run in the order in which they are shown: for each protocol the rates of every
/// method (best bold, second underlined) with their means, sweeps, where the protocols' rankings
/// differ, what the removed points were, the controls, then the time of each stage (the paper's
/// Table 3).
std::vector<TextTable> make_tables(const RunResults& results, const TableOptions& options = {});

std::string tables_markdown(const RunResults& results, const std::vector<TextTable>& tables);
std::string tables_latex(const std::vector<TextTable>& tables);

}  // namespace raymoval
