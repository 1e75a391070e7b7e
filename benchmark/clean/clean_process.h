// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "benchmark/clean/clean_paths.h"
#include "core/error.h"

namespace raymoval {

/// Runs this program as a child process that cleans, and watches its memory. No unfinished file of
/// `paths` is left, however the child ends.
/// @param arguments of the child, without the program's name; it prints where this process does
/// @param memory_limit_mib of the child and its descendants; 0: no known limit
/// @param cancel ends the child when it becomes true
/// @return the exit code of the child, which has printed the reason itself
/// @throws DataError if it was ended for its memory, MethodError if it crashed, Cancelled
ExitCode clean_in_child(const std::vector<std::string>& arguments, const CleanPaths& paths,
                        double memory_limit_mib, const std::atomic<bool>& cancel);

}  // namespace raymoval
