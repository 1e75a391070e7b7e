// SPDX-License-Identifier: MIT
#pragma once

#include "methods/registry.h"

namespace raymoval {

/// The program `raymoval`: parses the command line, runs the command, tells errors on standard
/// error as `raymoval: message`. A program with methods of its own names them in `methods`, which
/// has to live as long as the call.
/// @return the exit code, see `ExitCode`
int run_command_line(int argc, const char* const* argv,
                     const MethodRegistry& methods = MethodRegistry::built_in());

}  // namespace raymoval
