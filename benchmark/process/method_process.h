// SPDX-License-Identifier: MIT
#pragma once

#include "benchmark/process/method_run.h"

namespace raymoval {

/// The name of the command that a child process is started with. Users never see it.
inline constexpr const char* kMethodCommand = "run-method";

/// Runs a method in a child process (this program with `kMethodCommand`). If the method crashes,
/// hangs or leaks, the answer has a status, a reason and the end of the method's output.
/// @param task with a place
/// @throws Cancelled; DataError if no process can be started
MethodAnswer run_method_in_child(const MethodTask& task);

/// The child's side: reads the order from the descriptors of `run_method_in_child`, and writes the
/// answer to them. @throws UsageError if there are no such descriptors, because a user typed the
/// command
void serve_method(const MethodRegistry& registry);

}  // namespace raymoval
