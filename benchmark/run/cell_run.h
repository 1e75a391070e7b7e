// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "benchmark/process/method_run.h"
#include "benchmark/result/cell.h"
#include "benchmark/run/scored_sequence.h"
#include "benchmark/suite/suite.h"

namespace raymoval {

/// The inputs of the cell's key. @throws DataError if the data cannot be read
CellIdentity cell_identity(ScoredSequence& scored, const MethodRequest& request);

/// The key that a cell of this program has now. @throws DataError if the data cannot be read
std::string current_key(ScoredSequence& scored, const MethodRequest& request);

/// Runs the method, checks its answer and scores it. A fault of the method or the data does not
/// throw, but gives a cell with a status and a reason.
/// @param removals folder for label files; none are written if it is empty
/// @throws Cancelled, or DataError if the removals cannot be written
Cell execute_cell(ScoredSequence& scored, const MethodTask& task,
                  const std::filesystem::path& removals = {});

/// The cell of a sequence that cannot be read: status "bad_data".
Cell unreadable_cell(const std::string& sequence, const MethodRequest& request,
                     const std::string& reason);

}  // namespace raymoval
