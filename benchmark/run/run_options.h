// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"

namespace raymoval {

/// How a suite is run.
struct RunOptions {
  std::filesystem::path out;   ///< Run folder; made if it is missing.
  bool keep_removals = false;  ///< Whether label files are kept beside each cell.
  bool confidence = false;     ///< Whether methods give confidences.
  Progress* progress = nullptr;
  const std::atomic<bool>* cancel = nullptr;
  /// Whether each method runs in a child process, with the suite's limits. The child is this
  /// program, which must support `kMethodCommand` (benchmark/process/method_process.h).
  bool isolate = false;
  /// Number of cells that run at once, each with one thread if there are several. Their times are
  /// marked as taken side by side.
  int jobs = 1;
  std::vector<std::string> only = {};  ///< Patterns of the cells that are run, see `select_cells`.
  bool collect = false;                ///< Whether results are made of the stored cells only.
  /// Whether results of another suite or other data are replaced; else the run is refused.
  bool overwrite = false;
};

}  // namespace raymoval
