// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "core/error.h"

namespace raymoval {

/// The parts of messages about a command in a child process. Sentences begin with a blank.
struct CommandWords {
  std::string doing;             ///< Such as "cleaning".
  std::string outcome = {};      ///< " Nothing was written."
  std::string less_memory = {};  ///< Advice on using less memory.
  std::string after_crash = {};  ///< Advice after a crash.
};

/// Runs this program as a child process that carries out a command, and watches its memory.
/// @param arguments of the child, without the program's name; it prints where this process does
/// @param memory_limit_mib of the child and its descendants; 0: no known limit
/// @param cancel ends the child when it becomes true
/// @return the exit code of the child, which has printed the reason itself
/// @throws DataError if it was ended for its memory, MethodError if it crashed, Cancelled
ExitCode run_command_in_child(const std::vector<std::string>& arguments, const CommandWords& words,
                              double memory_limit_mib, const std::atomic<bool>& cancel);

}  // namespace raymoval
