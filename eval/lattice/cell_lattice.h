// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/floor.h"
#include "core/scan/cell_set.h"
#include "core/scan/voxel_key.h"
#include "core/scan/voxel_numbers.h"

namespace raymoval {

/// The cell of a world point: `voxel_index` without a call for each axis.
/// @throws DataError beyond the lattice
inline VoxelIndex cell_index(const Eigen::Vector3d& point, double inverse_size) {
  const Eigen::Vector3d place = point * inverse_size;
  const bool is_inside = std::abs(place.x()) < kVoxelLimit && std::abs(place.y()) < kVoxelLimit &&
                         std::abs(place.z()) < kVoxelLimit;
  if (!is_inside) return voxel_index(point, inverse_size);
  return {floor_of(place.x()), floor_of(place.y()), floor_of(place.z())};
}

inline VoxelKey cell_key(const Eigen::Vector3d& point, double inverse_size) {
  return voxel_key(cell_index(point, inverse_size));
}

/// How many bits are set, without a call on processors that have no instruction for it.
constexpr int bits_set(std::uint64_t word) {
  word -= word >> 1 & 0x5555555555555555U;
  word = (word & 0x3333333333333333U) + (word >> 2 & 0x3333333333333333U);
  word = (word + (word >> 4)) & 0x0F0F0F0F0F0F0F0FU;
  return static_cast<int>(word * 0x0101010101010101U >> 56);
}

/// The cell at an offset in steps. Beyond the lattice's end this is a cell far away.
constexpr VoxelKey cell_beside(VoxelKey cell, int dx, int dy, int dz) {
  const auto step = [](int count, int axis) {
    return static_cast<VoxelKey>(static_cast<std::int64_t>(count)) << (axis * kVoxelBits);
  };
  return cell + step(dx, 0) + step(dy, 1) + step(dz, 2);
}

/// Inserts many cells, of which the next one is mostly in the same brick as the last.
class CellInserter {
 public:
  explicit CellInserter(CellSet& set) : set_(set) {}
  ~CellInserter() { flush(); }
  CellInserter(const CellInserter&) = delete;
  CellInserter& operator=(const CellInserter&) = delete;

  void insert(VoxelKey cell) {
    if (brick_of(cell) != brick_) {
      flush();
      brick_ = brick_of(cell);
    }
    cells_ |= std::uint64_t{1} << place_in_brick(cell);
  }

 private:
  void flush() {
    if (cells_ != 0) set_.insert_brick(brick_, cells_);
    cells_ = 0;
  }
  CellSet& set_;
  VoxelKey brick_ = 0;
  std::uint64_t cells_ = 0;
};

/// A set of cells that are numbered from 0. Cells that are close in space have close numbers, so a
/// table by number uses the processor's caches well. It takes 32 bytes per brick, which is about
/// five per cell of a usual map.
class CellLattice {
 public:
  using Number = std::uint32_t;
  static constexpr Number kNone = std::numeric_limits<Number>::max();

  /// Remembers the brick that was used last. Each thread has one of its own.
  struct Cursor {
    VoxelKey brick = ~VoxelKey{0};
    std::uint32_t position = kNone;
  };

  CellLattice() = default;
  /// @param cells are empty afterwards, so that they are not in memory twice for long
  /// @throws DataError if there are 2^32 - 1 cells or more
  explicit CellLattice(CellSet cells);

  [[nodiscard]] std::size_t size() const { return size_; }

  /// The number of a cell; `kNone` if it is not in the set.
  [[nodiscard]] Number find(VoxelKey cell, Cursor& cursor) const {
    const VoxelKey brick = brick_of(cell);
    if (brick != cursor.brick) {
      cursor = {brick, positions_.find(brick, KeyOfBrick{bricks_.data()})};
    }
    if (cursor.position == kNone) return kNone;
    const Brick& cells = bricks_[cursor.position];
    const std::uint64_t bit = std::uint64_t{1} << place_in_brick(cell);
    if ((cells.bits & bit) == 0) return kNone;
    return cells.first + static_cast<Number>(bits_set(cells.bits & (bit - 1)));
  }

  [[nodiscard]] bool contains(VoxelKey cell, Cursor& cursor) const {
    return find(cell, cursor) != kNone;
  }

  /// Calls `visit(number, cell)` for each cell, in the order of the numbers.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for_each_in(0, bricks(), visit);
  }

  /// Bytes of memory.
  [[nodiscard]] std::size_t bytes() const {
    return bricks_.capacity() * sizeof(Brick) + positions_.bytes();
  }

  /// Number of bricks, for loops that divide the work by bricks.
  [[nodiscard]] std::size_t bricks() const { return bricks_.size(); }
  /// The same as `for_each` for the bricks [begin, end).
  template <class Visit>
  void for_each_in(std::size_t begin, std::size_t end, Visit&& visit) const {
    for (std::size_t i = begin; i < end; ++i) {
      Number number = bricks_[i].first;
      for (std::uint64_t left = bricks_[i].bits; left != 0; left &= left - 1) {
        visit(number++, cell_at(bricks_[i].key, std::countr_zero(left)));
      }
    }
  }

 private:
  struct Brick {
    VoxelKey key;
    std::uint64_t bits;
    Number first;  ///< Number of its first cell.
  };
  struct KeyOfBrick {
    const Brick* bricks;
    VoxelKey operator()(VoxelNumbers::Number position) const { return bricks[position].key; }
  };
  static_assert(VoxelNumbers::kNone == kNone);

  std::size_t size_ = 0;
  std::vector<Brick> bricks_;  ///< Along a Morton curve.
  VoxelNumbers positions_;     ///< Index of a brick in `bricks_`.
};

}  // namespace raymoval
