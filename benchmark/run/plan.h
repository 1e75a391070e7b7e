// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "benchmark/result/run_record.h"
#include "benchmark/run/run_options.h"
#include "benchmark/suite/suite.h"

namespace raymoval {

/// The planned action of a run for a cell.
struct PlannedCell {
  CellName cell;
  std::string key = {};               ///< Empty if the sequence cannot be read.
  std::string method = {};            ///< With its variant.
  std::filesystem::path folder = {};  ///< Within the run folder.
  std::size_t scans = 0;
  bool to_run = true;
  std::string why = {};  ///< Why it must be run, or why it is not selected.
};

/// The planned actions of a run.
struct SuitePlan {
  std::vector<PlannedCell> cells;     ///< The cells of the suite, in their order.
  std::vector<CellName> earlier;      ///< Cells of earlier runs that stay in the tables.
  std::vector<std::string> left_out;  ///< Other cells of earlier runs, each with the reason.
  std::string refused;                ///< Why the run would be refused; else empty.
};

/// Plans the actions of `run_suite`. No method is run, and only simulated scenes are written, to
/// the cache. Without `options.out`, every cell must be run.
SuitePlan plan_suite(const Suite& suite, const RunOptions& options);

}  // namespace raymoval
