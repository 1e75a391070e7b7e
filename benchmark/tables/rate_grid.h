// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "benchmark/result/results.h"
#include "benchmark/tables/table_options.h"
#include "benchmark/tables/text_table.h"

namespace raymoval {

/// A method's rates by sequence, from the run or from elsewhere.
struct MethodRates {
  std::string heading;
  std::vector<const RateValues*> by_sequence = {};  ///< Null: not known there.
  std::vector<std::string> status = {};             ///< Shown where there are no rates.
  std::vector<std::optional<double>> ms = {};       ///< Per scan, by sequence.
  std::optional<double> mean_ms = std::nullopt;     ///< Over all scans.
  int printed_digits = 0;  ///< Decimals that were printed elsewhere; 0: rates of the run.

  [[nodiscard]] std::optional<double> rate(std::size_t sequence, const std::string& name) const;
  /// The values of a rate over the sequences.
  [[nodiscard]] std::vector<std::optional<double>> values(const std::string& name) const;
  /// Those of PR and RR in one: F1 of the mean PR and the mean RR, over the sequences with both.
  [[nodiscard]] std::string f1_of_means_text(const TableOptions& options) const;
};

/// Sequences x methods x rates, of which a table is made by one layout or the other.
struct RateGrid {
  std::string title;
  std::vector<std::string> sequences;
  std::vector<MethodRates> methods;
  std::vector<std::string> rates;
  bool ranked = true;  ///< Whether best and second are marked and means are shown.
  bool timed = false;  ///< Whether times stand beside the rates.
};

/// By rows: one table with a block for each sequence, then one of the means.
std::vector<TextTable> method_rows(const RateGrid& grid, const TableOptions& options);

/// The paper's Table 2: a row for each sequence, methods side by side, means below.
TextTable methods_side_by_side(const RateGrid& grid, const TableOptions& options);

/// Either, as the options say.
std::vector<TextTable> rate_tables(const RateGrid& grid, const TableOptions& options);

}  // namespace raymoval
