// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "benchmark/result/results.h"
#include "benchmark/tables/table_options.h"
#include "benchmark/tables/text/text_table.h"
#include "eval/averages.h"

namespace raymoval {

/// A method's rates by sequence, from the run or from elsewhere.
struct MethodRates {
  std::string heading;
  std::vector<const std::vector<Rate>*> by_sequence = {};  ///< Null: not known there.
  std::vector<std::string> status = {};                    ///< Shown where there are no rates.
  std::vector<std::optional<double>> ms = {};              ///< Per scan, by sequence.
  std::optional<double> mean_ms = std::nullopt;            ///< Over all scans.
  std::vector<const ColumnRecord*> columns = {};           ///< By sequence; null: not known there.
  const MethodColumns* all_columns = nullptr;              ///< Over all sequences.
  int printed_digits = 0;  ///< Decimals that were printed elsewhere; 0: rates of the run.

  /// The values of a rate on the sequences.
  [[nodiscard]] SegmentValues values(const std::string& name) const;
};

/// The rates of a method by a protocol on each sequence of the run, and its times.
MethodRates method_rates(const RunResults& results, const std::string& method,
                         const std::string& protocol);

/// Sequences x methods x rates: the input of both table layouts.
struct RateGrid {
  std::string title;
  std::vector<std::string> sequences;
  std::vector<MethodRates> methods;
  std::vector<std::string> rates;
  bool ranked = true;  ///< Whether best and second are marked and means are shown.
  std::vector<std::string> shares = {};  ///< Columns that are shown beside the rates.
  bool timed = false;                    ///< Whether times are shown beside the rates.
  const char* no_time = "-";             ///< Text for an unknown time.
};

/// What the columns of objects are, for the notes of tables.
inline constexpr const char* kObjectWords =
    "parked: share of the points of a parked object that are kept, mean over objects; trails: "
    "share "
    "of moving objects of which at least 95 % is removed; in percent, by the instances of labels.";

/// The columns of objects that some cell of the run has: `parked`, `trails`.
std::vector<std::string> object_shares(const RunResults& results);

/// A row for each method in a block for each sequence, in the order of the grid, without marks.
TextTable sequence_blocks(const RateGrid& grid, const TableOptions& options);

/// Sorts the rows of each block by the options; rows without a value come last.
void sort_blocks(TextTable& table, const RateGrid& grid, const TableOptions& options);

/// The means of a method's rates over the sequences, and its time if the grid has times.
TableRow mean_row(const RateGrid& grid, const MethodRates& method, const TableOptions& options);

/// The tables in the layout of the options. kMethodRows: a table with a block for each sequence,
/// then one of the means. kSequenceRows (the paper's Table 2): a row for each sequence, methods
/// side by side, means below.
std::vector<TextTable> rate_tables(const RateGrid& grid, const TableOptions& options);

}  // namespace raymoval
