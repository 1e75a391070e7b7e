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

/// What became of the points of a scan.
struct ScanPresence {
  PointCounts points;
  std::int64_t kept_static = 0;      ///< Static and not flagged.
  std::int64_t flagged_dynamic = 0;  ///< Dynamic and flagged.
  std::int64_t present_static = 0;   ///< Static with a kept point within the distance.
  std::int64_t removed_dynamic = 0;  ///< Dynamic without one.

  ScanPresence& operator+=(const ScanPresence& other);
};

/// What does not depend on masks.
struct TruthBlocks {
  CellLattice blocks;               ///< Those with points that are in range.
  std::vector<PointCounts> points;  ///< Of each scan.
};

/// @throws DataError if no point at all is left to score against, or one lies beyond the lattice
TruthBlocks truth_blocks(const TruthPoints& truth, const FineGrid& grid);

/// Counts for each scan how many of its points are kept, and how many have a kept point of any scan
/// (the point itself included) at `options.distance` metres or less.
///
/// A kept point is its own partner, so partners are searched for flagged points only. The first
/// pass finds the blocks that have any. The second one marks the fine cells of flagged points, and
/// of kept ones in these blocks and those beside them. That decides on most flagged points: one
/// that shares its cell with a kept point is present, one without a kept point two cells around is
/// gone. The third pass counts these and collects the others, with the kept points around them, and
/// these are searched. Where marks or points are too many for the room that the number of blocks
/// gives them, only those of the first blocks stay, and further passes take those of the next ones.
/// So memory is bounded by the map: at most 16 bytes a block for the marks and 12 for the points,
/// but room for each of them is never less than 128 MiB.
class PresenceCount : public ScanVisitor {
 public:
  struct Input {
    const TruthPoints& truth;
    const Options& options;
    const FineGrid& grid;
    const TruthBlocks& blocks;  ///< Of the truth.
  };

  /// Bytes for what passes collect; 0: as many as the number of blocks allows.
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
  /// What it holds in memory now, without the truth.
  [[nodiscard]] virtual std::size_t bytes() const = 0;
};

/// The same counts for masks that already say which points are present.
/// @throws MethodError, DataError as `load_checked`
std::vector<ScanPresence> presence_by_index(const TruthPoints& truth, const MaskStore& masks);

}  // namespace raymoval::dynamicmap
