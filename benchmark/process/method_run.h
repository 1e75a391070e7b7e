// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "benchmark/result/cell.h"
#include "benchmark/result/removals/reasons.h"
#include "benchmark/suite/suite.h"
#include "core/process/child_process.h"
#include "core/progress.h"
#include "core/scan/confidence_store.h"
#include "core/scan/mask_store.h"
#include "datasets/reading/loaded_data.h"
#include "methods/remover.h"

namespace raymoval {

/// How a method runs, and what it is asked for besides its masks.
struct MethodOptions {
  int threads = 1;
  bool with_reasons = false;     ///< Why it removed points.
  bool with_confidence = false;  ///< How sure it is of each point, if it has a confidence.
};

/// One method on one sequence.
struct MethodTask {
  const Sequence* sequence = nullptr;
  const MethodRequest* request = nullptr;
  MethodOptions options = {};
  Progress* progress = nullptr;
  const std::atomic<bool>* cancel = nullptr;
  /// Where a child process opens the sequence. If it is null, the method runs in this process.
  const SequenceRequest* place = nullptr;
  ChildLimits limits = {};  ///< Of the child process.
  /// A path beside which the answer is kept in files without names. If it is empty, the answer is
  /// kept in memory.
  std::filesystem::path spool_beside = {};
};

/// What came of it. There are `masks` and `measured` only if `status` is kOk.
struct MethodAnswer {
  CellStatus status = CellStatus::kOk;
  std::string reason;
  std::string output_tail;  ///< Of a method that ran in a process of its own and failed.
  MaskStore masks;
  Measurement measured;
  Reasons reasons = {};             ///< Empty if it was not asked, or has none.
  ConfidenceStore confidence = {};  ///< The same.
  /// What was read of the sequence, if the method ran in a process of its own.
  std::optional<LoadedData> loaded = std::nullopt;
};

/// Runs a remover in this process and checks its answer. This is the one place where methods run,
/// for `run`, `clean` and Python alike.
/// @throws whatever the method throws; MethodError if it does not keep to its contract; DataError
/// if the answer cannot be kept
MethodAnswer run_remover(Remover& remover, const MethodTask& task);

/// Runs the task's method in this process. Never throws for a fault of the method or the data.
/// @throws Cancelled
MethodAnswer run_method(const MethodTask& task);

/// @throws DataError that points to `raymoval clean` if `sequence` has no labels
void check_has_labels(const Sequence& sequence);

/// The remover of `method`, with merged clouds split into their sensors; one that needs the truth
/// answers from the labels. `sequence` must outlive it.
/// @throws DataError if it needs labels and there are none
std::unique_ptr<Remover> make_remover(const ConfiguredMethod& method, const Sequence& sequence);

}  // namespace raymoval
