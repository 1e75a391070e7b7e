// SPDX-License-Identifier: MIT
#pragma once

namespace raymoval {

/// The program `raymoval`: parses the command line, runs the command, tells errors on standard
/// error as `raymoval: message`. @return the exit code, see `ExitCode`
int run_command_line(int argc, const char* const* argv);

}  // namespace raymoval
