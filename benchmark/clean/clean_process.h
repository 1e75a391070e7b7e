// SPDX-License-Identifier: MIT
#pragma once

#include "benchmark/clean/clean_outputs.h"
#include "core/error.h"

namespace raymoval {

/// Runs this very command again in a child process, with `--in-process`, and watches its memory.
/// However the child ends, nothing unfinished is left of `paths`.
/// @param memory_limit_mib of the child and all that it starts; 0: none is known
/// @return what the child answered, which has said why itself
/// @throws DataError if it was ended for its memory, MethodError if it crashed, Cancelled
ExitCode clean_apart(const CleanPaths& paths, double memory_limit_mib);

}  // namespace raymoval
