// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "benchmark/process/method_run.h"
#include "benchmark/suite/suite.h"
#include "core/progress.h"

namespace raymoval {

/// What a process tells the child that it starts to run a method.
struct MethodOrder {
  SequenceRequest place;  ///< Where the child opens the sequence, and how.
  MethodRequest request;  ///< The child needs its name, method and parameters only.
  MethodOptions options = {};
  /// Which way is up there, which takes reading scans to find out.
  UpDirection up = {};
  ProgressStyle progress = ProgressStyle::kQuiet;
  std::string progress_context = {};
};

// Both messages are files, since a pipe would hold up whoever writes more than the other reads.

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
