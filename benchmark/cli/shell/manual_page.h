// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "benchmark/cli/shell/command_tree.h"

namespace raymoval {

/// The manual page raymoval(1), for `man`: every command with the texts of its --help.
std::string manual_page(const CommandTree& tree);

}  // namespace raymoval
