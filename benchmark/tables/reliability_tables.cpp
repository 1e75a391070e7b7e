// SPDX-License-Identifier: MIT
#include "benchmark/tables/tables.h"
#include "core/text.h"

namespace raymoval {
namespace {

/// A share as a text with three decimals, or a dash.
TableCell share_cell(const std::optional<double>& share) {
  return share ? number_cell(*share, 3) : TableCell{"-"};
}

TextTable reliability_table(const MethodReliability& method) {
  TextTable table{"Confidence of " + method.cell,
                  "said to move",
                  {{"", {"points", "mean said", "share that moves"}}},
                  {},
                  {}};
  for (std::size_t i = 0; i < kConfidenceBins; ++i) {
    const ReliabilityBin& bin = method.all.bins[i];
    const double width = 1.0 / static_cast<double>(kConfidenceBins);
    table.rows.push_back({fixed_text(static_cast<double>(i) * width, 1) + " to " +
                              fixed_text(static_cast<double>(i + 1) * width, 1),
                          {{grouped_text(static_cast<std::uint64_t>(bin.points))},
                           share_cell(bin.mean_confidence()),
                           share_cell(bin.moving_share())},
                          false});
  }
  const auto error = method.all.expected_error(), gap = method.all.mean_gap();
  table.notes.push_back("By the points' labels, over " +
                        counted_text(method.sequences, "sequence") +
                        ". Expected calibration error " + (error ? fixed_text(*error, 5) : "-") +
                        " (bins weighted by their points, of which nearly all stay); mean gap " +
                        (gap ? fixed_text(*gap, 3) : "-") + " (bins of " +
                        std::to_string(kFewestInBin) + " points or more count alike).");
  return table;
}

}  // namespace

std::vector<TextTable> reliability_tables(const RunResults& results) {
  std::vector<TextTable> tables;
  for (const MethodReliability& method : results.reliability) {
    tables.push_back(reliability_table(method));
  }
  return tables;
}

}  // namespace raymoval
