// SPDX-License-Identifier: MIT
#include "benchmark/run/plan.h"

#include "benchmark/run/cell_run.h"
#include "benchmark/run/opened_suite.h"

namespace raymoval {
namespace {

PlannedCell plan_cell(const OpenedSuite& suite, ScoredSequence& scored, CellIndex index,
                      const std::string& unreadable) {
  const MethodRequest& method = suite.method(index);
  PlannedCell planned{suite.name(index)};
  planned.method = method.method.full_name();
  planned.folder = CellStore("").folder(planned.cell);
  planned.scans = scored.sequence().scans->size();
  planned.why = "is not there yet";
  if (!unreadable.empty()) {
    planned.why = "its data cannot be read: " + unreadable;
  } else {
    planned.key = current_key(scored, method);
    if (!suite.options().out.empty()) {
      const StoredCell stored = suite.stored_cell(scored, index);
      planned.why = stored.why;
      planned.to_run = stored.state != StoredCell::State::kFresh;
    }
  }
  if (!suite.is_selected(index)) {
    planned.to_run = false;
    planned.why = "is not selected";
  }
  return planned;
}

void plan_sequence(OpenedSuite& suite, std::size_t sequence, std::vector<PlannedCell>& cells) {
  ScoredSequence scored = suite.take_sequence(sequence);
  std::string unreadable;
  try {
    (void)scored.data_fingerprint();
  } catch (const DataError& error) {
    unreadable = error.what();
  }
  for (std::size_t method = 0; method < suite.suite().methods.size(); ++method) {
    cells.push_back(plan_cell(suite, scored, {sequence, method}, unreadable));
  }
}

}  // namespace

SuitePlan plan_suite(const Suite& suite, const RunOptions& options) {
  OpenedSuite opened(suite, options);
  SuitePlan plan;
  if (!options.out.empty()) {
    try {
      const EarlierCells earlier = join_folder(opened).earlier;
      for (const Cell& cell : earlier.kept) plan.earlier.push_back({cell.sequence, cell.name});
      plan.left_out = earlier.left_out;
    } catch (const UsageError& error) {
      plan.refused = error.what();
    }
  }
  for (std::size_t i = 0; i < opened.sequences().size(); ++i) {
    plan_sequence(opened, i, plan.cells);
  }
  return plan;
}

}  // namespace raymoval
