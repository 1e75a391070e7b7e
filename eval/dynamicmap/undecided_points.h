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

namespace raymoval::dynamicmap {

/// For each block of a lattice whether it, or one beside it, is chosen.
/// @param is_chosen says so of a block, by its number
std::vector<std::uint8_t> with_blocks_beside(const CellLattice& blocks,
                                             const std::function<bool(std::uint32_t)>& is_chosen);

/// Flagged points that have a kept point near but not in their fine cell, and the kept points
/// around them, for a range of blocks at a time. The range begins with all blocks that are left.
/// Where the points get too many, its end moves down and the points beyond it are forgotten; they
/// have their turn in a later pass.
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
  /// What one scan adds.
  struct Found {
    std::vector<Flagged> flagged;
    std::vector<Eigen::Vector3d> kept;
  };

  /// @param map outlives this object
  /// @param room bytes for points; 0: as many as the number of blocks allows
  UndecidedPoints(const Map& map, std::size_t room);

  /// Begins with the first range. The marks of `flagged` are complete now.
  void begin();
  /// Begins with the blocks behind the last range. @return false if there is none
  bool begin_next();

  /// Whether the flagged points of a block are collected in this pass. It may say so of a block
  /// whose turn ends meanwhile; `add` knows.
  [[nodiscard]] bool has_turn(Number block) const { return block >= first_ && block < end_; }
  /// Whether a point of a block may matter: any flagged one does, and a kept one near those that
  /// are undecided.
  [[nodiscard]] bool may_matter(Number block, bool is_kept) const {
    return !is_kept || is_near_flagged_[block] != 0;
  }
  /// Whether a kept point in this cell may be near a flagged one that is collected.
  [[nodiscard]] bool is_wanted(const FineCell& cell, CellLattice::Cursor& cursor) const {
    return map_.flagged.any_near(cell, map_.blocks, cursor, first_, end_);
  }
  void add(const Found& found);

  /// Calls `present` for each collected flagged point that has a kept point within the distance,
  /// and forgets all points.
  void search(int threads, const std::function<void(const Flagged&)>& present);

 private:
  [[nodiscard]] std::size_t bytes() const;
  bool narrow();

  Map map_;
  std::size_t room_;
  Number first_ = 0;
  std::atomic<Number> end_ = 0;
  std::vector<std::uint8_t> is_near_flagged_;  ///< Of each block: it, or one beside it, is flagged.
  std::vector<Flagged> flagged_;
  std::vector<Eigen::Vector3d> kept_;
};

}  // namespace raymoval::dynamicmap
