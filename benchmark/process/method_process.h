// SPDX-License-Identifier: MIT
#pragma once

#include "benchmark/process/method_run.h"

namespace raymoval {

/// The name of the command that a child process is started with. Users never see it.
inline constexpr const char* kMethodCommand = "run-method";

/// Runs a method in a child process (this program with `kMethodCommand`). If the method crashes,
/// hangs or leaks there, the answer has a status, a reason and the end of what it printed.
/// @param task with a place
/// @throws Cancelled; DataError if no process can be started
MethodAnswer run_method_apart(const MethodTask& task);

/// The child's side: reads the order from the descriptors that `run_method_apart` gives it, and
/// answers there. @throws UsageError if there are none because somebody typed the command
void serve_method(const MethodRegistry& registry);

}  // namespace raymoval
