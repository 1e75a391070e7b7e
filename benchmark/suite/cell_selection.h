// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace raymoval {

/// Whether each cell fits one of the patterns; all cells do if there are no patterns.
/// @param only patterns with * and ? of SEQUENCE/NAME, SEQUENCE or NAME
/// @param cells "SEQUENCE/NAME"
/// @param of the owner of the cells, for messages
/// @throws UsageError if a pattern fits no cell
std::vector<bool> select_cells(const std::vector<std::string>& only,
                               const std::vector<std::string>& cells,
                               const std::string& of = "suite");

}  // namespace raymoval
