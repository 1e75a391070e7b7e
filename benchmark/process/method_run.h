// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>

#include "benchmark/result/cell.h"
#include "benchmark/result/removals/reasons.h"
#include "benchmark/suite/suite.h"
#include "core/progress.h"
#include "core/scan/confidence_store.h"
#include "core/scan/mask_store.h"
#include "datasets/reading/loaded_data.h"

namespace raymoval {

/// One method on one sequence.
struct MethodTask {
  const Sequence* sequence = nullptr;
  const MethodRequest* request = nullptr;
  int threads = 1;
  Progress* progress = nullptr;
  const std::atomic<bool>* cancel = nullptr;
  bool with_reasons = false;  ///< Whether the method is asked why.
  /// Whether scans are loaded before the method asks for them, if the machine has a second core.
  bool loads_ahead = true;
  bool with_confidence = false;  ///< Whether the method is asked how sure it is, if it can say.
};

/// What came of it. There are `masks` and `measured` only if `status` is kOk.
struct MethodAnswer {
  CellStatus status = CellStatus::kOk;
  std::string reason;
  std::string output_tail;  ///< Of a method that ran in a process of its own and failed.
  MaskStore masks;
  Measurement measured;
  Reasons reasons = {};             ///< Empty if it was not asked, or cannot say.
  ConfidenceStore confidence = {};  ///< The same.
  /// What was read of the sequence, if the method ran in a process of its own.
  std::optional<LoadedData> loaded = std::nullopt;
};

/// Runs a method in this process and checks its answer. Never throws for a fault of the method or
/// the data. @throws Cancelled
MethodAnswer run_method(const MethodTask& task);

/// @throws DataError that points to `raymoval clean` if `sequence` has no labels
void check_has_labels(const Sequence& sequence);

/// The remover of `method`; one that needs the truth answers from the labels.
/// @throws DataError if it needs labels and there are none
std::unique_ptr<Remover> make_remover(const ConfiguredMethod& method, const Sequence& sequence);

}  // namespace raymoval
