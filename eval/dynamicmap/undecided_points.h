// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "eval/dynamicmap/fine_cells.h"
#include "eval/lattice/cell_lattice.h"
#include "eval/lattice/ranked_bits.h"

namespace raymoval::dynamicmap {

/// Flagged points that have a kept point near but not in their fine cell, and the kept points
/// around them, for a range of blocks at a time. The range begins with all blocks that are given.
/// If there are too many points, its end moves down and the points beyond it are dropped. A later
/// pass handles them.
class UndecidedPoints {
 public:
  using Number = CellLattice::Number;

  struct Map {
    double distance;
    const FineGrid& grid;
    const CellLattice& blocks;
    const FineBits& flagged;  ///< Cells whose flagged points are undecided.
  };
  struct Flagged {
    Eigen::Vector3d point;
    Number block;
    std::uint32_t scan;
    bool moving;
  };
  /// The points of one scan.
  struct Found {
    std::vector<Flagged> flagged;
    std::vector<Eigen::Vector3d> kept;
  };

  /// @param map outlives this object
  /// @param room bytes for points
  UndecidedPoints(const Map& map, std::size_t room);

  /// Begins with the blocks [first, last). The marks of `flagged` are complete now.
  void begin(Number first, Number last);
  /// Begins with those of them that are behind the last range. @return false if there is none
  bool begin_next();

  /// Whether the flagged points of a block are collected in this pass. It may be true for a block
  /// that is dropped meanwhile; `add` checks again.
  [[nodiscard]] bool has_turn(Number block) const { return block >= first_ && block < end_; }
  /// Whether undecided flagged points may be near a block.
  [[nodiscard]] bool is_near_flagged(Number block) const { return is_near_flagged_.test(block); }
  /// Whether a kept point in this cell may be near a flagged one that is collected.
  [[nodiscard]] bool is_wanted(const FineCell& cell, CellLattice::Cursor& cursor) const {
    return map_.flagged.any_near(cell, map_.blocks, cursor, first_, end_);
  }
  void add(const Found& found);

  /// Calls `present` for each collected flagged point that has a kept point within the distance,
  /// and forgets all points.
  void search(int threads, const std::function<void(const Flagged&)>& present);

  /// Bytes of memory of the points and of their search.
  [[nodiscard]] std::size_t bytes() const;

 private:
  bool narrow();

  Map map_;
  std::size_t room_;
  Number first_ = 0;
  std::atomic<Number> end_ = 0;
  Number last_ = 0;             ///< Where the ranges end.
  RankedBits is_near_flagged_;  ///< Of each block: it, or one beside it, is flagged.
  std::vector<Flagged> flagged_;
  std::vector<Eigen::Vector3d> kept_;
};

}  // namespace raymoval::dynamicmap
