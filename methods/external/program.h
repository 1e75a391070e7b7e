// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace raymoval::external_method {

/// How a program is started.
struct ProgramCall {
  std::vector<std::string> command;  ///< Program (looked up on PATH without a '/') and arguments.
  std::filesystem::path folder;      ///< Its working folder.
  std::vector<std::pair<std::string, std::string>> environment;  ///< Beside this process's own.
  double time_limit_s = 0.0;                                     ///< 0 means no limit.
  double disk_limit_gib = 0.0;                ///< Of the files in its folder; 0 means no limit.
  const std::atomic<bool>* cancel = nullptr;  ///< The program is ended when this becomes true.
};

/// Runs a program to its end as `run_child` does. What it prints is kept for messages only.
/// @throws MethodError if it cannot be started, exceeds its time or disk, crashes, or ends with
/// another exit code than 0 (with the end of what it printed); Cancelled
void run_program(const ProgramCall& call);

}  // namespace raymoval::external_method
