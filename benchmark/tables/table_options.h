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

/// How tables of rates are to look.
struct TableOptions {
  std::vector<std::string> what = {};  ///< Of `table_kinds`; empty: all.
  TableLayout layout = TableLayout::kMethodRows;
  std::vector<std::string> rates = {};  ///< In this order, also kTimeRate; empty: the main ones.
  std::optional<int> decimals = {};  ///< Of every rate; nothing: as many as the rate's spec says.
  std::map<std::string, int> decimals_of = {};  ///< Of one rate; overrides `decimals`.
  std::string sort = "none";   ///< A rate, kTimeRate, kMemoryColumn, "name" or "none".
  bool disagreements = false;  ///< Whether each pair that protocols rank otherwise is named.
  std::vector<OutsideColumn> outside = {};  ///< Set beside the run, see `set_beside`.
};

/// A rate as the options want it: "98.123".
/// @param printed digits that were printed elsewhere, to which none are added; 0: any number
TableCell rate_cell(const TableOptions& options, const std::string& rate, double value,
                    int printed = 0);

/// A mean as the options want it: "98.123", or "98.123 (4/5)" if sequences without a value are left
/// out; "n/a" if all are. @param of how many sequences there are
TableCell mean_cell(const TableOptions& options, const std::string& rate, const Mean& mean,
                    std::size_t of, int printed = 0);

/// "Rates in percent, F1 as a fraction.", and for which of the rates lower is better, if for any.
std::string rate_units_text(const std::vector<std::string>& rates);

bool is_among(const std::vector<std::string>& names, const std::string& name);

/// Adds `name` unless it is there.
void add_once(std::vector<std::string>& names, const std::string& name);

/// The rates of a protocol that are to be shown, without the time.
std::vector<std::string> chosen_rates(const TableOptions& options, const RunResults& results,
                                      const std::string& protocol);

/// Whether the time per scan is asked for beside the rates. Without that, tables of rates hold
/// nothing that differs from run to run.
bool shows_time(const TableOptions& options);

/// @throws UsageError if the run has no such rate, or sorting by it makes no sense
void check_rates(const TableOptions& options, const RunResults& results);

/// The methods, best first by their mean over these sequences, as displayed, of what
/// `TableOptions::sort` names. Those without a value come last.
std::vector<std::string> methods_sorted_by(const RunResults& results,
                                           const std::vector<std::string>& sequences,
                                           const std::string& column);

/// The same over all sequences by the main rate of the first protocol.
std::vector<std::string> methods_best_first(const RunResults& results);

/// Puts all that is listed by method into that order, the cells within each sequence.
void sort_results(const std::string& column, RunResults& results);

/// Reads "2" or "F1=3" into the options. @throws UsageError
void parse_decimals(const std::string& text, TableOptions& options);

/// What sequences and methods are called in tables, by their names in the run.
using DisplayNames = std::map<std::string, std::string>;

/// Reads "NAME=SHOWN", or the lines of the file `text` in that form ('#' starts a comment).
/// @throws UsageError, DataError
void parse_display_names(const std::string& text, const RunResults& results, DisplayNames& names);

/// Gives sequences, methods and outside columns the names that they are shown by.
/// @throws UsageError if two methods or two sequences would be shown by one name
void apply_display_names(const DisplayNames& names, RunResults& results,
                         std::vector<OutsideColumn>& outside);

}  // namespace raymoval
