// SPDX-License-Identifier: MIT
#include "eval/dynamicmap/marked_cells.h"

#include <utility>

namespace raymoval::dynamicmap {
std::size_t set_blocks_around(VoxelKey block, const CellLattice& blocks,
                              CellLattice::Cursor& cursor, RankedBits& bits) {
  std::size_t added = 0;
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        const auto beside = blocks.find(cell_beside(block, x, y, z), cursor);
        if (beside == CellLattice::kNone || bits.test(beside)) continue;
        bits.set(beside);
        ++added;
      }
    }
  }
  return added;
}

MarkedCells::MarkedCells(const CellLattice& blocks, std::size_t room)
    : blocks_(blocks), room_(room), has_flagged_(blocks.size()) {}

bool MarkedCells::begin_next() {
  kept_ = {};  // Both free their memory before more is allocated.
  flagged_ = {};
  first_ = end_;
  end_ = static_cast<Number>(blocks_.size());
  RankedBits flagged(blocks_.size()), near(blocks_.size());
  CellLattice::Cursor cursor;
  std::size_t chosen = 0;
  blocks_.for_each([&](Number number, VoxelKey block) {
    if (!has_turn(number) || !has_flagged_.test(number)) return;
    flagged.set(number);
    chosen += 1 + set_blocks_around(block, blocks_, cursor, near);
    if (chosen * FineBits::kBytesPerBlock >= room_) end_ = number + 1;
  });
  if (chosen == 0) return false;
  flagged.count_through();
  near.count_through();
  flagged_ = FineBits(std::move(flagged));
  kept_ = FineBits(std::move(near));
  return true;
}

std::size_t MarkedCells::bytes() const {
  return has_flagged_.bytes() + kept_.bytes() + flagged_.bytes();
}

}  // namespace raymoval::dynamicmap
