// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "benchmark/cli/shell/command_tree.h"

namespace raymoval {

/// The script that completes commands, options and their values in a shell.
/// @param shell bash, zsh or fish
/// @throws UsageError for another shell
std::string completion_script(const CommandTree& tree, const std::string& shell);

}  // namespace raymoval
