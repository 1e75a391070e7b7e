// SPDX-License-Identifier: MIT
#pragma once

#include "eval/erasor/maps/accumulate.h"
#include "eval/lattice/cell_lattice.h"
#include "eval/lattice/ranked_bits.h"

namespace raymoval::erasor {

/// The cells of a sequence, whatever is removed of it.
struct MapCells {
  /// Every cell with a point. The points of the dense map lie in no others: a mean is between the
  /// lowest and the highest of its points along each axis, also when it is rounded.
  CellLattice all;
  /// Cells in which the class of a voxel, or of a point of the dense map, hangs on which points are
  /// near: those within two cells of a point that moves, or is a truck. A voxel's nearest point is
  /// never farther than half a diagonal from its mean, and the point from which that one has its
  /// label is not farther from it again, so none three cells away can give it its label.
  RankedBits mixed;
  RankedBits near_mixed;  ///< `mixed` and the cells beside it.

  /// What they take in memory.
  [[nodiscard]] std::size_t bytes() const {
    return all.bytes() + mixed.bytes() + near_mixed.bytes();
  }
};

/// Finds the cells of a sequence, in one pass.
/// @throws DataError beyond the lattice
MapCells map_cells(const MapRules& rules);

}  // namespace raymoval::erasor
