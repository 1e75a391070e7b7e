// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "benchmark/result/run_record.h"
#include "benchmark/run/run_options.h"
#include "benchmark/suite/suite.h"

namespace raymoval {

/// What a run would do with a cell.
struct PlannedCell {
  CellName cell;
  std::string key = {};               ///< Empty if the sequence cannot be read.
  std::string method = {};            ///< With its variant.
  std::filesystem::path folder = {};  ///< Within the run folder.
  std::size_t scans = 0;
  bool to_run = true;
  std::string why = {};  ///< Why it has to be run, or why it is not selected.
};

/// What a run would do.
struct SuitePlan {
  std::vector<PlannedCell> cells;     ///< Those of the suite, in their order.
  std::vector<CellName> earlier;      ///< Cells of earlier runs that stay in the tables.
  std::vector<std::string> left_out;  ///< Other cells of earlier runs, each with the reason.
  std::string refused;                ///< Why the run would be refused; empty if it would not.
};

/// Tells what `run_suite` would do. Nothing is run and nothing is written, but simulated scenes go
/// to the cache. Without `options.out` every cell is to be run.
SuitePlan plan_suite(const Suite& suite, const RunOptions& options);

}  // namespace raymoval
