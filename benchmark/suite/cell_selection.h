// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace raymoval {

/// The selected cells of a suite: all by default.
struct CellSelection {
  std::vector<std::string> only;  ///< Patterns with * and ?; a cell is chosen if one fits it.
  std::size_t shard = 1;          ///< The number of the part, counted from 1.
  std::size_t shards = 1;         ///< The number of parts.

  [[nodiscard]] bool everything() const { return only.empty() && shards == 1; }
};

/// Reads "2/3", the second of three parts. @throws UsageError that names the form
void parse_shard(const std::string& text, CellSelection& selection);

/// Whether each cell is selected. `--shard` divides the cells that `--only` leaves into parts of
/// neighbours, so that a part reads few sequences. Part sizes differ by at most one cell, and every
/// cell is in exactly one part.
/// @param cells "SEQUENCE/NAME"
/// @param of the owner of the cells, for messages
/// @throws UsageError if a pattern fits no cell
std::vector<bool> select_cells(const CellSelection& selection,
                               const std::vector<std::string>& cells,
                               const std::string& of = "suite");

}  // namespace raymoval
