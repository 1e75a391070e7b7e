// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "benchmark/run/folder_content.h"
#include "benchmark/suite/cell_selection.h"
#include "benchmark/suite/suite.h"
#include "core/progress.h"

namespace raymoval {

/// How a suite is run, besides what it runs.
struct RunOptions {
  std::filesystem::path out;   ///< Run folder; made if missing.
  bool keep_removals = false;  ///< Whether label files are kept beside each cell.
  Progress* progress = nullptr;
  const std::atomic<bool>* cancel = nullptr;
  /// Whether each method runs in a child process, with the suite's limits. The child is this very
  /// program, which has to know `kMethodCommand` (benchmark/process/method_process.h).
  bool isolate = false;
  CellSelection selection = {};
  bool collect = false;  ///< Nothing is run: results are made of the cells that are there.
  /// Whether results of another suite or on other data give way; else the run is refused.
  bool overwrite = false;
};

struct RunSummary {
  std::size_t cells = 0;
  std::size_t reused = 0;                ///< Cells that were there already and are right.
  std::size_t earlier = 0;               ///< Cells of earlier runs, besides these, in the tables.
  std::vector<std::string> failures;     ///< "sequence / method: reason", one for each failed cell.
  std::vector<std::string> controls;     ///< What is wrong with the controls; empty if all is well.
  std::vector<std::string> flat_sweeps;  ///< Sentences on swept parameters without effect.
  std::vector<std::string> missing;      ///< "sequence / method" of cells that were not run.
  [[nodiscard]] bool good() const { return failures.empty() && controls.empty(); }
};

/// Runs every selected cell of `suite` that is not yet in the run folder with the right key, then
/// writes results and tables of all cells that are there: also of those that earlier runs left and
/// that belong together with these (benchmark/run/folder_content.h). A cell that fails is recorded,
/// and the rest goes on. The folder is locked meanwhile.
/// @throws UsageError if the folder holds other results and they are not to be overwritten;
/// UsageError, DataError or ConfigurationError if the suite cannot start, none of its
/// sequences can be read, or results cannot be written; Cancelled (finished cells stay and are used
/// again next time)
RunSummary run_suite(const Suite& suite, const RunOptions& options);

/// Runs one cell and writes nothing but its folder; several may be run at once in one run folder.
/// @param cell its key, or "SEQUENCE/NAME"
/// @throws as run_suite; UsageError if the suite has no such cell, or somebody else runs it
RunSummary run_one_cell(const Suite& suite, const RunOptions& options, const std::string& cell);

/// What a run would do with a cell.
struct PlannedCell {
  std::string key;  ///< Empty if the sequence cannot be read.
  std::string sequence;
  std::string name;
  std::string method;            ///< With its variant.
  std::filesystem::path folder;  ///< Within the run folder.
  std::size_t scans = 0;
  bool to_run = true;
  std::string why;  ///< Why it has to be run; why it is not selected.
};

/// What a run would do.
struct SuitePlan {
  std::vector<PlannedCell> cells;  ///< Those of the suite, in their order.
  std::vector<FolderCell> earlier;
  std::vector<std::string> left_out;  ///< Of earlier runs, with the reason.
  std::string refused;                ///< Why the run would be refused; empty if it would not.
};

/// Nothing is run and nothing written (but simulated scenes go to the cache). Without `options.out`
/// every cell is to be run.
SuitePlan plan_suite(const Suite& suite, const RunOptions& options);

}  // namespace raymoval
