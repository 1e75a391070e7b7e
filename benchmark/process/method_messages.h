// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "benchmark/process/method_run.h"
#include "benchmark/suite/suite.h"
#include "core/progress.h"

namespace raymoval {

/// The message to a child process that runs a method.
struct MethodOrder {
  SequenceRequest place;  ///< The sequence, and how the child opens it.
  MethodRequest request;  ///< The child needs its name, method and parameters only.
  MethodOptions options = {};
  /// The up direction of the sequence, which is costly: it is found by reading scans.
  UpDirection up = {};
  ProgressStyle progress = ProgressStyle::kQuiet;
  std::string progress_context = {};
};

// Both messages are files, because a full pipe would block the writing process.

/// @param task with a place
/// @throws DataError if `file` cannot be written
void write_order(int file, const MethodTask& task);
/// @throws nlohmann::json::exception or MethodError if the order is not whole
MethodOrder read_order(int file, const MethodRegistry& registry);

/// @throws DataError if `file` cannot be written
void write_answer(int file, const MethodAnswer& answer);
/// @throws nlohmann::json::exception or MethodError if the answer is not whole, since a method may
/// write to any file of its process
MethodAnswer read_answer(int file);

}  // namespace raymoval
