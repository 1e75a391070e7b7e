// SPDX-License-Identifier: MIT
#pragma once

#include "methods/erasor/polar_bins.h"

namespace raymoval::erasor_method {

/// What the scan ratio test finds in a bin.
enum class BinFinding {
  kTooFewPoints,   ///< Too few query points to say anything.
  kQueryOnly,      ///< The map has nothing here.
  kMapHigher,      ///< Something tall is in the map that the query does not see.
  kCurrentHigher,  ///< The query sees something tall that the map does not have.
  kEqual,          ///< Extents agree; also where both are zero.
};

/// Compares the vertical extents of a bin (its pseudo occupancies): unequal if the smaller one is
/// strictly less than `threshold` times the larger one.
BinFinding compare_extents(const BinExtent& map, const BinExtent& query,
                           const Parameters& parameters);

/// What is done to the map in a bin.
struct BinAction {
  bool remove = false;    ///< Map voxels above the ground go out.
  bool reinsert = false;  ///< Voxels with a query point come in.
};

/// Version 3: only bins where the map is higher, and taller than `minimum_object_height`, change.
/// Version 2: the map must reach above `minimum_top` instead, and bins of equal extents and those
/// that only the query fills take in the query's points.
BinAction action_for(BinFinding finding, const BinExtent& map, const Parameters& parameters);

}  // namespace raymoval::erasor_method
