// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include "benchmark/result/results.h"

namespace raymoval {

/// Rates on a sequence that do not come from the run.
struct OutsideRow {
  std::string sequence;  ///< As the paper calls it.
  std::vector<Rate> rates;
  std::string beside = {};  ///< The sequence of the run with the same frames; empty if none has.
};

/// Rates that do not come from the run, such as a method's rows of a paper.
struct OutsideColumn {
  std::string heading;
  std::string protocol;  ///< Name in the registry of protocols.
  std::vector<OutsideRow> rows;

  /// Rates on the sequence called `name` by `which`: `&OutsideRow::sequence` or
  /// `&OutsideRow::beside`. Null if there are none.
  [[nodiscard]] const std::vector<Rate>* find(std::string OutsideRow::*which,
                                              const std::string& name) const;
};

/// How papers print the rates of a protocol.
struct PublishedForm {
  const char* title = "Published";
  const char* sequence_prefix = "";  ///< Prefix of a paper's name in the shipped suites.
  /// Frames of the papers' sequences, by the papers' names, where they are known.
  std::map<std::string, std::string> frames = {};
  int decimals = 3;        ///< Digits that are printed.
  bool comparable = true;  ///< Whether all rows are of one kind of data, over which a mean
                           ///< makes sense.
  const char* note = "";   ///< Text below the table.
  std::vector<const char*> files = {};
};

/// How papers print the rates of the protocol called `protocol` in the registry.
const PublishedForm& published_form(const std::string& protocol);

/// The methods of published tables, as columns to set beside a run: Table 2 of the paper, on the
/// segments of the suite `semantickitti`, the tables of the DynamicMap benchmark, on the sequences
/// of `kth`, and those of moving-object segmentation. The tables are read from the folder
/// `shipped_data("published")`.
/// @throws DataError if there is no such folder
std::vector<OutsideColumn> published_columns();

/// Assigns rows to the sequences of the run that have the paper's name (with or without the
/// prefix), frames and number of scans. The fingerprint of the papers' data is not known.
/// @return a line with the reason for each sequence without comparable rows
std::vector<std::string> set_beside(std::vector<OutsideColumn>& columns, const RunResults& results);

}  // namespace raymoval
