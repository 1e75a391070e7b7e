// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "eval/dynamicmap/options.h"
#include "eval/dynamicmap/truth_points.h"

namespace raymoval::dynamicmap {

/// What a scan's points of the truth came to.
struct ScanPresence {
  PointCounts points;
  std::int64_t kept_static = 0;      ///< Static and not flagged.
  std::int64_t flagged_dynamic = 0;  ///< Dynamic and flagged.
  std::int64_t present_static = 0;   ///< Static with a kept point within the distance.
  std::int64_t removed_dynamic = 0;  ///< Dynamic without one.

  ScanPresence& operator+=(const ScanPresence& other);
};

/// For each scan, how many of its points are kept, and how many have any kept point of any scan,
/// themselves included, at `options.distance` metres or less.
///
/// A kept point is its own partner, so only flagged ones are searched for. They and the kept points
/// around them stay in memory, all else streams by, and time grows with the points times the
/// logarithm of their number, however often a place was seen.
/// @throws MethodError, DataError as `load_checked`; DataError beyond the lattice
std::vector<ScanPresence> measure_presence(const TruthPoints& truth, const MaskStore& masks,
                                           const Options& options);

/// The same where the masks already say what is present.
std::vector<ScanPresence> presence_by_index(const TruthPoints& truth, const MaskStore& masks);

}  // namespace raymoval::dynamicmap
