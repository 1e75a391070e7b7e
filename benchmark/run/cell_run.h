// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <filesystem>
#include <string>

#include "benchmark/process/method_run.h"
#include "benchmark/result/cell.h"
#include "benchmark/run/scored_sequence.h"
#include "benchmark/suite/suite.h"
#include "core/process/child_process.h"

namespace raymoval {

/// What it takes to run a method on a sequence and to score it.
struct CellTask {
  ScoredSequence* scored = nullptr;
  const MethodRequest* request = nullptr;
  std::filesystem::path removals;  ///< Folder for label files; none are written if it is empty.
  const std::atomic<bool>* cancel = nullptr;
  /// Where a process of its own opens the sequence. If it is null, the method runs in this process.
  const SequenceRequest* place = nullptr;
  ChildLimits limits;
  bool is_alone = true;  ///< Whether no other cell runs meanwhile, so that a core may be idle.
  bool with_confidence = false;  ///< Whether the method is asked how sure it is, if it can say.
};

/// What the cell's key is made from. @throws DataError if the data cannot be read
CellIdentity cell_identity(ScoredSequence& scored, const MethodRequest& request);

/// The key that a cell of this program has now. @throws DataError if the data cannot be read
std::string current_key(ScoredSequence& scored, const MethodRequest& request);

/// Runs the method, checks its answer and scores it. It does not throw for a fault of the method or
/// the data: that is a cell with a status and a reason.
/// @throws Cancelled, or DataError if the removals cannot be written
Cell execute_cell(const CellTask& task);

/// Runs the method once more, for its time. @throws Cancelled
MethodAnswer repeat_cell(const CellTask& task);

/// The cell of a sequence that cannot be read: status "bad_data".
Cell unreadable_cell(const std::string& sequence, const MethodRequest& request,
                     const std::string& reason);

}  // namespace raymoval
