// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "eval/dynamicmap/options.h"
#include "eval/dynamicmap/truth_points.h"

namespace raymoval::dynamicmap {

/// What became of the points of a scan.
struct ScanPresence {
  PointCounts points;
  std::int64_t kept_static = 0;      ///< Static and not flagged.
  std::int64_t flagged_dynamic = 0;  ///< Dynamic and flagged.
  std::int64_t present_static = 0;   ///< Static with a kept point within the distance.
  std::int64_t removed_dynamic = 0;  ///< Dynamic without one.

  ScanPresence& operator+=(const ScanPresence& other);
};

/// Counts for each scan how many of its points are kept, and how many have a kept point of any scan
/// (the point itself included) at `options.distance` metres or less.
///
/// A kept point is its own partner, so partners are searched for flagged points only. These points
/// and the kept ones around them stay in memory, all others are read and forgotten. The time grows
/// with n log n for n points, however often a place was seen.
/// @throws MethodError, DataError as `load_checked`; DataError beyond the lattice
std::vector<ScanPresence> measure_presence(const TruthPoints& truth, const MaskStore& masks,
                                           const Options& options);

/// The same counts for masks that already say which points are present.
std::vector<ScanPresence> presence_by_index(const TruthPoints& truth, const MaskStore& masks);

}  // namespace raymoval::dynamicmap
