// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <filesystem>

#include "benchmark/suite/cell_selection.h"
#include "core/progress.h"

namespace raymoval {

/// How a suite is run, besides what it runs.
struct RunOptions {
  std::filesystem::path out;   ///< Run folder; it is made if it is missing.
  bool keep_removals = false;  ///< Whether label files are kept beside each cell.
  bool confidence = false;     ///< Whether methods are asked how sure they are of each point.
  Progress* progress = nullptr;
  const std::atomic<bool>* cancel = nullptr;
  /// Whether each method runs in a child process, with the suite's limits. The child is this very
  /// program, which has to know `kMethodCommand` (benchmark/process/method_process.h).
  bool isolate = false;
  /// So many cells run at once, each with one thread. Their times are marked as taken side by side.
  int jobs = 1;
  CellSelection selection = {};
  bool collect = false;  ///< Whether nothing is run, and results are made of the cells there are.
  /// Whether results of another suite or on other data give way; else the run is refused.
  bool overwrite = false;
};

}  // namespace raymoval
