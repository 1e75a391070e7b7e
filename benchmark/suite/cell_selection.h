// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace raymoval {

/// Which cells of a suite a run is about; all if nothing is said.
struct CellSelection {
  std::vector<std::string> only;  ///< Patterns with * and ?; a cell is in if one fits.
  std::size_t shard = 1;          ///< This part ...
  std::size_t shards = 1;         ///< ... of so many.

  [[nodiscard]] bool everything() const { return only.empty() && shards == 1; }
};

/// "2/3". @throws UsageError saying what the form is
void parse_shard(const std::string& text, CellSelection& selection);

/// Which of the cells are in, in their order. `--shard` cuts what `--only` leaves into parts of
/// neighbours, so that a part reads few sequences; the parts differ by one cell at most, and every
/// cell is in exactly one.
/// @param cells "SEQUENCE/NAME"
/// @param of what they are the cells of, for messages
/// @throws UsageError if a pattern fits no cell
std::vector<bool> select_cells(const CellSelection& selection,
                               const std::vector<std::string>& cells,
                               const std::string& of = "suite");

}  // namespace raymoval
