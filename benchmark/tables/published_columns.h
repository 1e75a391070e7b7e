// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "benchmark/result/results.h"

namespace raymoval {

/// Rates that do not come from the run, such as a method's row of a paper.
struct OutsideColumn {
  std::string heading;
  std::string protocol;  ///< Name in the registry of protocols.
  std::vector<std::pair<std::string, std::vector<Rate>>> sequences;

  /// Rates of what a run calls `name`. A paper may call "05" what the shipped suites call
  /// "kitti-05" (see `PublishedForm`). Null if there are none.
  [[nodiscard]] const std::vector<Rate>* find(const std::string& name) const;
};

/// How papers print the rates of a protocol.
struct PublishedForm {
  const char* title = "Published";
  const char* sequence_prefix = "";  ///< Stands before a paper's name in the shipped suites.
  int decimals = 3;                  ///< Digits that are printed.
  bool comparable = true;  ///< Whether all rows are of one kind of data, over which a mean
                           ///< makes sense.
  const char* note = "";   ///< Stands below the table.
  std::vector<const char*> files = {};
};

/// How papers print the rates of the protocol called `protocol` in the registry.
const PublishedForm& published_form(const std::string& protocol);

/// The methods of published tables, as columns to set beside a run: Table 2 of the paper, on the
/// segments of the suite `semantickitti`, the tables of the DynamicMap benchmark, on the sequences
/// of `kth`, and those of moving-object segmentation. The tables are looked up in the source
/// folder, else where they were installed.
/// @throws DataError if they are in neither place
std::vector<OutsideColumn> published_columns();

}  // namespace raymoval
