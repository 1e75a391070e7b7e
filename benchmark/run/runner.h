// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "benchmark/run/run_options.h"
#include "benchmark/suite/suite.h"

namespace raymoval {

/// The summary at the end of a run.
struct RunSummary {
  std::size_t cells = 0;
  std::size_t reused = 0;               ///< Stored cells that were reused.
  std::size_t earlier = 0;              ///< Other cells of earlier runs in the tables.
  std::vector<std::string> failures;    ///< "sequence / method: reason", one for each failed cell.
  std::vector<std::string> controls;    ///< Problems of the controls.
  std::vector<std::string> lost_scans;  ///< "sequence: sentence" on scans that were not read.
  std::vector<std::string> missing;     ///< "sequence / method" of cells that were not run.
  [[nodiscard]] bool good() const { return failures.empty() && controls.empty(); }
};

/// Runs every selected cell of `suite` that is not yet in the run folder with the right key. Then
/// writes results and tables of all cells in the folder, including matching cells of earlier runs
/// (benchmark/run/folder/folder_content.h). A failed cell is recorded, and the run continues. The
/// folder is locked meanwhile.
/// @throws UsageError if the folder holds other results and `overwrite` is not set; UsageError,
/// DataError or ConfigurationError if the suite cannot start, none of its sequences can be read, or
/// results cannot be written; Cancelled (finished cells stay and are used again next time)
RunSummary run_suite(const Suite& suite, const RunOptions& options);

/// Runs one cell and writes only its folder. Several processes may do so at once in one run folder.
/// @param cell its key, or "SEQUENCE/NAME"
/// @throws as run_suite; UsageError if the suite has no such cell, or another process runs it
RunSummary run_one_cell(const Suite& suite, const RunOptions& options, const std::string& cell);

}  // namespace raymoval
