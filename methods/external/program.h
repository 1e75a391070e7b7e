// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace raymoval {

/// How a program is started.
struct ProgramCall {
  std::vector<std::string> command;  ///< Program (looked up on PATH without a '/') and arguments.
  std::filesystem::path folder;      ///< Its working folder.
  std::vector<std::pair<std::string, std::string>> environment;  ///< Beside this process's own.
  double time_limit_s = 0.0;                                     ///< 0: none.
  const std::atomic<bool>* cancel = nullptr;                     ///< Set: the program is ended.
};

/// Runs a program to its end. It has no standard input and none of this process's files; what it
/// prints is kept for messages only, the last 4 KiB of it. If this process dies, so does the
/// program.
/// @return the end of what it printed
/// @throws MethodError if it cannot be started, exceeds its time, crashes, or ends with another
/// exit code than 0 (with the end of what it printed); Cancelled. With all that it started it is
/// ended first.
std::string run_program(const ProgramCall& call);

}  // namespace raymoval
