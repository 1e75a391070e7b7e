// SPDX-License-Identifier: MIT
#pragma once

#include "methods/registry.h"

namespace raymoval {

/// The program `raymoval`: it parses the command line, runs the command, and prints an error as
/// `raymoval: message` on standard error. A program with methods of its own is this function with
/// another registry:
///
///     int main(int argc, char** argv) {
///       raymoval::MethodRegistry methods = raymoval::MethodRegistry::built_in();
///       methods.add(my_entry());
///       return raymoval::run_command_line(argc, argv, methods);
///     }
///
/// `run` and `clean` start the program itself again for each method, with a command that --help
/// does not show. So `main` must not do or print anything before this call.
/// Help shows the name by which the program was started.
/// @param methods the methods of the program; must outlive the call
/// @return the exit code, see `ExitCode`
int run_command_line(int argc, const char* const* argv, const MethodRegistry& methods);

/// The same with the built-in methods.
int run_command_line(int argc, const char* const* argv);

}  // namespace raymoval
