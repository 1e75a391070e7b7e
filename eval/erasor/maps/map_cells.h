// SPDX-License-Identifier: MIT
#pragma once

#include "eval/erasor/maps/accumulate.h"
#include "eval/lattice/cell_lattice.h"
#include "eval/lattice/ranked_bits.h"

namespace raymoval::erasor {

/// The cells of a sequence, which do not depend on masks.
struct MapCells {
  /// Every cell with a point. The points of the dense map lie in no others: a mean is between the
  /// lowest and the highest of its points along each axis, also when it is rounded.
  CellLattice all;
  /// Cells in which the class of a voxel, or of a point of the dense map, depends on nearby points:
  /// cells within two cells of a moving point or a truck. The nearest point of a voxel is never
  /// farther than half a diagonal from the voxel's mean. The point that gives this point its label
  /// is never farther than that from it. So no point three cells away can give the voxel its label.
  RankedBits mixed;
  RankedBits near_mixed;  ///< `mixed` and the cells beside it.

  /// Bytes of memory.
  [[nodiscard]] std::size_t bytes() const {
    return all.bytes() + mixed.bytes() + near_mixed.bytes();
  }
};

/// Finds the cells of a sequence, in one pass.
/// @throws DataError beyond the lattice
MapCells map_cells(const MapRules& rules);

}  // namespace raymoval::erasor
