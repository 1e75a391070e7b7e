// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "eval/dynamicmap/fine_cells.h"
#include "eval/dynamicmap/options.h"
#include "eval/dynamicmap/truth_points.h"
#include "eval/lattice/cell_lattice.h"

namespace raymoval::dynamicmap {

/// Counts of the points of a scan.
struct ScanPresence {
  PointCounts points;
  std::int64_t kept_static = 0;      ///< Static and not flagged.
  std::int64_t flagged_dynamic = 0;  ///< Dynamic and flagged.
  std::int64_t present_static = 0;   ///< Static with a kept point within the distance.
  std::int64_t removed_dynamic = 0;  ///< Dynamic without one.

  ScanPresence& operator+=(const ScanPresence& other);
};

/// The part that does not depend on masks.
struct TruthBlocks {
  CellLattice blocks;               ///< Blocks with points in range.
  std::vector<PointCounts> points;  ///< Of each scan.
};

/// @throws DataError if no point at all is left to score against, or one lies beyond the lattice
TruthBlocks truth_blocks(const TruthPoints& truth, const FineGrid& grid);

/// Counts for each scan how many of its points are kept, and how many have a kept point of any scan
/// (the point itself included) at `options.distance` metres or less.
///
/// A kept point is its own partner, so partners are searched for flagged points only. The first
/// pass finds the blocks that have any. The second one marks the fine cells of flagged points, and
/// of kept ones in these blocks and those beside them. This decides most flagged points: a point
/// that shares its cell with a kept point is present, a point without a kept point two cells around
/// is gone. The third pass counts these and collects the others, with the kept points around them,
/// and these are searched. If there are too many marks or points for the memory, which depends on
/// the number of blocks, a pass handles only the first blocks, and further passes handle the next
/// ones. So memory is bounded by the map: at most 16 bytes per block for the marks and 12 for the
/// points, but at least 128 MiB for each of them.
class PresenceCount : public ScanVisitor {
 public:
  struct Input {
    const TruthPoints& truth;
    const Options& options;
    const FineGrid& grid;
    const TruthBlocks& blocks;  ///< Of the truth.
  };

  /// Bytes for collected marks and points; 0: derived from the number of blocks.
  struct Room {
    std::size_t marks = 0;
    std::size_t points = 0;  ///< That are searched.
  };
  /// Room for each block in large maps.
  static constexpr std::size_t kMarksPerBlock = 16;
  static constexpr std::size_t kPointsPerBlock = 12;

  /// @param input all its parts outlive the object
  static std::unique_ptr<PresenceCount> start(const Input& input, const Room& room);
  /// Called once, after the last pass.
  [[nodiscard]] virtual std::vector<ScanPresence> finish() = 0;
  /// Present bytes of memory, without the truth.
  [[nodiscard]] virtual std::size_t bytes() const = 0;
};

/// The same counts for masks that already say which points are present.
/// @throws MethodError, DataError as `load_checked`
std::vector<ScanPresence> presence_by_index(const TruthPoints& truth, const MaskStore& masks);

}  // namespace raymoval::dynamicmap
