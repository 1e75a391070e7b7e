// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/scan/scan.h"
#include "methods/removert/map_points.h"
#include "methods/removert/parameters.h"

namespace raymoval::removert_method {

/// Says for each point of a scan whether it is removed.
class Answer {
 public:
  virtual ~Answer() = default;
  /// Thread-safe. @param first_number number of the scan's first point in the input
  [[nodiscard]] virtual Mask of(const Scan& scan, std::uint64_t first_number) const = 0;
};

/// Answers by membership: a point is removed iff its cell is, or iff it is itself, if the map is
/// not thinned. Points that never entered the map, because of `keyframe_gap` or `scan_voxel`,
/// follow the nearest centroid within half a cell's diagonal, if their own cell is not in the map.
std::unique_ptr<Answer> answer_by_cell(const CellLattice& lattice, const MapPoints& kept,
                                       const MapPoints& removed, bool all_points_in_map);

/// The public code's scan-side step (not in the paper): a point is static iff the mean square
/// distances to its k nearest neighbours in its own scan (itself included) and in the static map
/// differ by less than `scan_side_threshold`.
std::unique_ptr<Answer> answer_by_neighbours(const MapPoints& kept, const Parameters& parameters);

}  // namespace raymoval::removert_method
