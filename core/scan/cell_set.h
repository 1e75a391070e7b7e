// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>

#include "core/scan/voxel_key.h"

namespace raymoval {

// Cells of a lattice are stored in bricks of 4 x 4 x 4, one bit each.

/// The brick of a cell: the key of its lowest cell, every index divided by four.
constexpr VoxelKey brick_of(VoxelKey cell) {
  constexpr VoxelKey kAxis = (VoxelKey{1} << (kVoxelBits - 2)) - 1;
  constexpr VoxelKey kAll = kAxis | kAxis << kVoxelBits | kAxis << (2 * kVoxelBits);
  return cell >> 2 & kAll;
}

/// The place of a cell in its brick, 0 to 63.
constexpr int place_in_brick(VoxelKey cell) {
  return static_cast<int>((cell & 3) | (cell >> kVoxelBits & 3) << 2 |
                          (cell >> (2 * kVoxelBits) & 3) << 4);
}

constexpr std::uint64_t bit_in_brick(VoxelKey cell) {
  return std::uint64_t{1} << place_in_brick(cell);
}

constexpr VoxelKey cell_at(VoxelKey brick, int place) {
  const auto of_place = static_cast<VoxelKey>(place);
  return brick << 2 | (of_place & 3) | (of_place >> 2 & 3) << kVoxelBits |
         (of_place >> 4 & 3) << (2 * kVoxelBits);
}

/// A set of cells that grows.
class CellSet {
 public:
  void insert(VoxelKey cell) { insert_brick(brick_of(cell), bit_in_brick(cell)); }
  void insert(const CellSet& other) {
    for (const auto& [brick, cells] : other.bricks_) insert_brick(brick, cells);
  }
  /// @param cells of the brick, by their bits
  void insert_brick(VoxelKey brick, std::uint64_t cells) {
    bricks_.try_emplace(brick, 0).first.value() |= cells;
  }
  [[nodiscard]] bool contains(VoxelKey cell) const {
    const auto found = bricks_.find(brick_of(cell));
    return found != bricks_.end() && (found->second & bit_in_brick(cell)) != 0;
  }
  /// Takes a cell out, if it is there. Its brick stays.
  void erase(VoxelKey cell) {
    const auto found = bricks_.find(brick_of(cell));
    if (found != bricks_.end()) found.value() &= ~bit_in_brick(cell);
  }
  void clear() { bricks_.clear(); }

  /// Calls `visit(brick, cells)` for each brick, in no particular order.
  template <class Visit>
  void for_each_brick(Visit&& visit) const {
    for (const auto& [brick, cells] : bricks_) visit(brick, cells);
  }
  /// Calls `visit(cell)` for each cell, in no particular order.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for_each_brick([&](VoxelKey brick, std::uint64_t cells) {
      for (; cells != 0; cells &= cells - 1) visit(cell_at(brick, std::countr_zero(cells)));
    });
  }

 private:
  friend class CellLattice;

  VoxelMap<std::uint64_t> bricks_;
};

}  // namespace raymoval
