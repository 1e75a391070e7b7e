// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "benchmark/result/results.h"
#include "benchmark/tables/table_options.h"
#include "benchmark/tables/text_table.h"

namespace raymoval {

/// The rates of the run's methods by a protocol. By rows: a block for each sequence, with papers'
/// rows in the blocks of sequences that they have; then, for several sequences, a table of the
/// means. In the paper's layout one table with both. None without methods or rates.
std::vector<TextTable> accuracy_tables(const RunResults& results, const std::string& protocol,
                                       const TableOptions& options);

/// The same of the controls, without marks and means, and whether they are as they must be.
std::vector<TextTable> control_tables(const RunResults& results, const std::string& protocol,
                                      const TableOptions& options);

/// All numbers of the papers that have a sequence of the run, by the protocols of the run.
std::vector<TextTable> published_tables(const RunResults& results, const TableOptions& options);

/// Sequences of the run for which no outside column has rates by a protocol of the run.
std::vector<std::string> unpublished_sequences(const RunResults& results,
                                               const std::vector<OutsideColumn>& outside);

/// Whether the controls are as they must be, in words.
std::string controls_text(const RunResults& results);

/// "98.123", or "98.123 (4/5)" where sequences without a value are left out; "n/a" without any.
std::string mean_text(const TableOptions& options, const std::string& rate,
                      const std::vector<std::optional<double>>& values, int printed = 0);

}  // namespace raymoval
