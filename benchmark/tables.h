// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "benchmark/results.h"
#include "benchmark/text_table.h"

namespace raymoval {

/// A column of rates that does not come from the run, such as a row of a paper.
struct OutsideColumn {
  std::string heading;
  std::string protocol;  ///< "erasor" or "dynamicmap".
  std::vector<std::pair<std::string, RateValues>> sequences;

  /// Rates of what a run calls `name`, which may be called "05" elsewhere instead of "kitti-05"
  /// (erasor) or "kth-05" (dynamicmap); null if there are none.
  [[nodiscard]] const RateValues* find(const std::string& name) const;
};

/// The tables of a run in the order in which they are shown: for each protocol sequence x method
/// (the paper's Table 2: best bold, second underlined, averages), where the protocols' rankings
/// differ, what the removed points were, the controls, then the time of each stage (the paper's
/// Table 3).
/// @param outside columns set beside those of the run where the protocol is theirs and a sequence
///   is in both; a table of all of them follows
std::vector<TextTable> make_tables(const RunResults& results,
                                   const std::vector<OutsideColumn>& outside = {});

std::string tables_markdown(const RunResults& results, const std::vector<TextTable>& tables);
std::string tables_latex(const std::vector<TextTable>& tables);

}  // namespace raymoval
