// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <set>

#include "methods/common/scan_grid.h"

namespace raymoval::toy {

using GridCells = std::set<std::array<int, 3>>;

/// The voxels of a scan's grid that are free or hit.
inline GridCells cells_of(const scan_grid::ScanGrid& grid, std::uint64_t scan_grid::Column::*word) {
  using namespace scan_grid;
  GridCells cells;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    for (int column = 0; column < kColumns; ++column) {
      for (auto left = grid[i].columns[static_cast<std::size_t>(column)].*word; left != 0;
           left &= left - 1) {
        cells.insert({grid[i].at.x() * kSide + column / kSide,
                      grid[i].at.y() * kSide + column % kSide,
                      grid[i].at.z() * kHeight + std::countr_zero(left)});
      }
    }
  }
  return cells;
}

}  // namespace raymoval::toy
