// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "eval/dynamicmap/fine_cells.h"
#include "eval/lattice/cell_lattice.h"
#include "eval/lattice/ranked_bits.h"

namespace raymoval::dynamicmap {

/// Sets the bits of a block and of those beside it. @return how many bits were not set before
std::size_t set_blocks_around(VoxelKey block, const CellLattice& blocks,
                              CellLattice::Cursor& cursor, RankedBits& bits);

/// Marks of the fine cells of flagged points, and of kept ones in blocks where flagged ones may be
/// near, for a range of blocks at a time: as many blocks as the marks have room for. Each flagged
/// point belongs to the range that its block is in.
class MarkedCells {
 public:
  using Number = CellLattice::Number;

  /// @param blocks outlive this object
  /// @param room bytes for marks
  MarkedCells(const CellLattice& blocks, std::size_t room);

  /// Notes that a block has flagged points. Several threads may do so at a time.
  void note_flagged(Number block) { has_flagged_.set(block); }

  /// Begins with the next range, which has no marks yet. All blocks with flagged points are noted.
  /// @return false if none of these is left
  bool begin_next();
  [[nodiscard]] Number first() const { return first_; }
  [[nodiscard]] Number end() const { return end_; }
  /// Whether the flagged points of a block belong to this range.
  [[nodiscard]] bool has_turn(Number block) const { return block >= first_ && block < end_; }
  /// Whether flagged points of this range may be near a block.
  [[nodiscard]] bool is_near_flagged(Number block) const { return kept_.is_chosen(block); }

  /// Marks the cell of a point. Several threads may do so at a time.
  /// @param block has its turn if the point is flagged, else may be near flagged ones
  void mark(Number block, const FineCell& cell, bool flagged) {
    (flagged ? flagged_ : kept_).set(block, cell);
  }
  /// Leaves those marks of flagged points whose cell has no kept point.
  void leave_undecided() { flagged_.subtract(kept_); }

  [[nodiscard]] const FineBits& kept() const { return kept_; }
  [[nodiscard]] const FineBits& flagged() const { return flagged_; }
  /// Bytes of memory.
  [[nodiscard]] std::size_t bytes() const;

 private:
  const CellLattice& blocks_;
  std::size_t room_;
  RankedBits has_flagged_;
  Number first_ = 0, end_ = 0;
  FineBits kept_;
  FineBits flagged_;
};

}  // namespace raymoval::dynamicmap
