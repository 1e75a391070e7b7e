// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "benchmark/suite.h"
#include "core/progress.h"

namespace raymoval {

/// How a suite is run, besides what it runs.
struct RunOptions {
  std::filesystem::path out;   ///< Run folder; made if missing.
  bool keep_removals = false;  ///< Whether label files are kept beside each cell.
  Progress* progress = nullptr;
  const std::atomic<bool>* cancel = nullptr;
};

struct RunSummary {
  std::size_t cells = 0;
  std::size_t reused = 0;             ///< Cells that were there already and are right.
  std::vector<std::string> failures;  ///< "sequence / method: reason", one for each failed cell.
  std::vector<std::string> controls;  ///< What is wrong with the controls; empty if all is well.
  [[nodiscard]] bool good() const { return failures.empty() && controls.empty(); }
};

/// Runs every cell of `suite` that is not yet in the run folder with the right key, then writes
/// results and tables. A cell that fails is recorded, and the rest goes on.
/// @throws UsageError, DataError or ConfigurationError if the suite cannot start, or none of its
/// sequences can be read; Cancelled (finished cells stay and are used again next time)
RunSummary run_suite(const Suite& suite, const RunOptions& options);

}  // namespace raymoval
