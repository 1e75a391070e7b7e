// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "benchmark/result/results.h"

namespace raymoval {

/// Rates that do not come from the run, such as a method's row of a paper.
struct OutsideColumn {
  std::string heading;
  std::string protocol;  ///< "erasor" or "dynamicmap".
  std::vector<std::pair<std::string, RateValues>> sequences;

  /// Rates of what a run calls `name`, which may be called "05" elsewhere instead of "kitti-05"
  /// (erasor) or "kth-05" (dynamicmap); null if there are none.
  [[nodiscard]] const RateValues* find(const std::string& name) const;
};

enum class TableLayout {
  kMethodRows,   ///< A row for each method, a column for each rate, a block for each sequence.
  kSequenceRows  ///< A row for each sequence, methods side by side: the paper's Table 2.
};

/// The column of times beside rates, by the name that users choose it by.
inline constexpr const char* kTimeRate = "ms";

/// How tables of rates are to look.
struct TableOptions {
  TableLayout layout = TableLayout::kMethodRows;
  std::vector<std::string> rates = {};  ///< In this order, also kTimeRate; empty: the main ones.
  std::optional<int> decimals = {};     ///< Of every rate; none: what is usual for the rate.
  std::map<std::string, int> decimals_of = {};  ///< Of one rate; comes before `decimals`.
  std::string sort = "none";                    ///< A rate, kTimeRate, "name" or "none".
  bool disagreements = false;  ///< Whether each pair that protocols rank otherwise is named.
  std::vector<OutsideColumn> outside = {};  ///< Set beside the run where a sequence is in both.
};

/// A rate as the options want it: "98.123".
/// @param printed digits that were printed elsewhere, of which none are added; 0: any number
std::string option_text(const TableOptions& options, const std::string& rate, double value,
                        int printed = 0);

/// The rates of a protocol that are to be shown, without the time.
std::vector<std::string> chosen_rates(const TableOptions& options, const RunResults& results,
                                      const std::string& protocol);

/// Whether the time per scan is asked for beside the rates. Without that, tables of rates hold
/// nothing that differs from run to run.
bool shows_time(const TableOptions& options);

/// @throws UsageError if the run has no such rate, or sorting by it makes no sense
void check_rates(const TableOptions& options, const RunResults& results);

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
