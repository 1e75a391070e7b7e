// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>

#include "benchmark/result/cell.h"
#include "benchmark/result/removals/reasons.h"
#include "benchmark/suite/suite.h"
#include "core/process/child_process.h"
#include "core/progress.h"
#include "core/scan/confidence_store.h"
#include "core/scan/mask_store.h"
#include "methods/remover.h"

namespace raymoval {

/// The options of a method's run, and its outputs besides masks.
struct MethodOptions {
  int threads = 1;
  bool with_reasons = false;     ///< Whether it gives reasons.
  bool with_confidence = false;  ///< Whether it gives confidences, if it has any.
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
  /// A path beside which the answer is kept in unnamed files. If it is empty, the answer is kept in
  /// memory.
  std::filesystem::path spool_beside = {};
};

/// The result. `masks` and `measured` are only set if `status` is kOk.
struct MethodAnswer {
  CellStatus status = CellStatus::kOk;
  std::string reason;
  std::string output_tail;  ///< Set if a method in its own process failed.
  MaskStore masks;
  Measurement measured;
  Reasons reasons = {};             ///< Empty if not requested, or if the method has none.
  ConfidenceStore confidence = {};  ///< The same.
};

/// Runs a remover in this process and checks its answer. This is the one place where methods run,
/// for `run`, `clean` and Python alike.
/// @throws any error of the method; MethodError if it breaks its contract; DataError if the answer
/// cannot be kept
MethodAnswer run_remover(Remover& remover, const MethodTask& task);

/// Runs the task's method in this process. Never throws for a fault of the method or the data.
/// @throws Cancelled
MethodAnswer run_method(const MethodTask& task);

/// @throws DataError that points to `raymoval clean` if `sequence` has no labels
void check_has_labels(const Sequence& sequence);

/// The remover of `method`, with merged clouds split into their sensors. If the method needs the
/// truth, the remover reads the labels. `sequence` must outlive it.
/// @throws DataError if it needs labels and there are none
std::unique_ptr<Remover> make_remover(const ConfiguredMethod& method, const Sequence& sequence);

}  // namespace raymoval
