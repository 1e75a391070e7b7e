// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "benchmark/result/results.h"
#include "benchmark/tables/published_columns.h"
#include "benchmark/tables/text/text_table.h"
#include "eval/averages.h"

namespace raymoval {

enum class TableLayout {
  kMethodRows,   ///< A row for each method, a column for each rate, a block for each sequence.
  kSequenceRows  ///< A row for each sequence, methods side by side: the paper's Table 2.
};

/// The column of times beside rates: the name by which users choose it, and its heading.
inline constexpr const char* kTimeRate = "ms";
inline constexpr const char* kTimeHeading = "ms per scan";
/// The column of the most memory, by which rows may be sorted.
inline constexpr const char* kMemoryColumn = "MiB";

/// Options of tables of rates.
struct TableOptions {
  std::vector<std::string> what = {};  ///< Of `table_kinds`; empty: all.
  TableLayout layout = TableLayout::kMethodRows;
  std::vector<std::string> rates = {};  ///< In this order, also kTimeRate; empty: the main ones.
  std::optional<int> decimals = {};  ///< Of every rate; nothing: as many as the rate's spec says.
  std::map<std::string, int> decimals_of = {};  ///< Of one rate; overrides `decimals`.
  std::string sort = "none";                ///< A rate, kTimeRate, kMemoryColumn, "name" or "none".
  std::vector<OutsideColumn> outside = {};  ///< Rates from elsewhere, see `set_beside`.
};

/// A rate in the form of the options: "98.123".
/// @param printed digits of a published rate, which limit the decimals; 0: no limit
TableCell rate_cell(const TableOptions& options, const std::string& rate, double value,
                    int printed = 0);

/// A mean in the form of the options: "98.123", or "98.123 (4/5)" if sequences without a value are
/// left out; "n/a" if all are. @param of the number of sequences
TableCell mean_cell(const TableOptions& options, const std::string& rate, const Mean& mean,
                    std::size_t of, int printed = 0);

/// "Rates in percent, F1 as a fraction.", and for which of the rates lower is better, if for any.
std::string rate_units_text(const std::vector<std::string>& rates);

bool is_among(const std::vector<std::string>& names, const std::string& name);

/// Adds `name` unless it is there.
void add_once(std::vector<std::string>& names, const std::string& name);

/// The shown rates of a protocol, without the time.
std::vector<std::string> chosen_rates(const TableOptions& options, const RunResults& results,
                                      const std::string& protocol);

/// Whether the time per scan is shown beside the rates. Without it, tables of rates do not differ
/// from run to run.
bool shows_time(const TableOptions& options);

/// @throws UsageError if the run lacks a rate, or cannot sort by one
void check_rates(const TableOptions& options, const RunResults& results);

/// The methods, best first by the displayed mean of `TableOptions::sort` over these sequences.
/// Methods without a value come last.
std::vector<std::string> methods_sorted_by(const RunResults& results,
                                           const std::vector<std::string>& sequences,
                                           const std::string& column);

/// The same over all sequences by the main rate of the first protocol.
std::vector<std::string> methods_best_first(const RunResults& results);

/// Sorts all lists of methods by that order, and the cells within each sequence.
void sort_results(const std::string& column, RunResults& results);

/// Reads "2" or "F1=3" into the options. @throws UsageError
void parse_decimals(const std::string& text, TableOptions& options);

}  // namespace raymoval
