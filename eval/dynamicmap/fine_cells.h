// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "eval/lattice/cell_lattice.h"
#include "eval/lattice/ranked_bits.h"

namespace raymoval::dynamicmap {

/// A place in a block of 8 x 8 x 8 fine cells.
struct FineCell {
  VoxelKey block;
  int x, y, z;  ///< 0 to 7.
};

/// Cuts the world into blocks of fine cells, an eighth of a block's edge each. An edge of a fine
/// cell is a little more than half of `distance`, so that points within `distance` of each other
/// are at most two fine cells apart along each axis, also after rounding.
class FineGrid {
 public:
  explicit FineGrid(double distance);

  /// @throws DataError beyond the lattice of blocks
  [[nodiscard]] FineCell cell_of(const Eigen::Vector3d& point) const {
    const VoxelIndex block = cell_index(point, inverse_edge_);
    const auto eighth = [&](int axis) {
      return std::min(7, static_cast<int>((point[axis] * inverse_edge_ - block[axis]) * 8.0));
    };
    return {voxel_key(block), eighth(0), eighth(1), eighth(2)};
  }
  /// Whether a point is within the lattice of blocks.
  [[nodiscard]] bool holds(const Eigen::Vector3d& point) const {
    return point.cwiseAbs().maxCoeff() * inverse_edge_ < kVoxelLimit;
  }
  [[nodiscard]] VoxelKey block_of(const Eigen::Vector3d& point) const {
    return cell_key(point, inverse_edge_);
  }
  [[nodiscard]] double blocks_a_metre() const { return inverse_edge_; }
  /// Whether any two points of a fine cell are at most `distance` apart.
  [[nodiscard]] bool same_cell_is_near() const { return same_cell_is_near_; }

  static constexpr int kReach = 2;

 private:
  double inverse_edge_;  ///< Of a block.
  bool same_cell_is_near_;
};

/// A bit for each fine cell of chosen blocks of a lattice, all 0 at first. It takes 64 bytes a
/// chosen block.
class FineBits {
 public:
  using Number = CellLattice::Number;

  FineBits() = default;
  /// @param chosen by the blocks' numbers, counted through
  explicit FineBits(RankedBits chosen);

  /// Several threads may set bits at a time. @param block is chosen
  void set(Number block, const FineCell& cell) {
    const std::atomic_ref<std::uint64_t> word(words_[index(block, cell.z)]);
    const std::uint64_t bit = bit_of(cell);
    // Most bits are set already, and reading is faster than writing.
    if ((word.load(std::memory_order_relaxed) & bit) == 0) {
      word.fetch_or(bit, std::memory_order_relaxed);
    }
  }
  [[nodiscard]] bool is_chosen(Number block) const { return chosen_.test(block); }
  [[nodiscard]] bool is_set(Number block, const FineCell& cell) const {
    return is_chosen(block) && (words_[index(block, cell.z)] & bit_of(cell)) != 0;
  }
  /// Clears the bits that are set in `other`.
  void subtract(const FineBits& other);
  /// Whether any bit of the block is set.
  [[nodiscard]] bool any(Number block) const;

  /// Whether a bit is set at most `FineGrid::kReach` cells away along each axis, in a block of
  /// `lattice` with a number in [first, end).
  [[nodiscard]] bool any_near(const FineCell& cell, const CellLattice& lattice,
                              CellLattice::Cursor& cursor, Number first, Number end) const;

  /// Bytes of memory.
  [[nodiscard]] std::size_t bytes() const {
    return chosen_.bytes() + words_.capacity() * sizeof(std::uint64_t);
  }
  static constexpr std::size_t kBytesPerBlock = 64;

 private:
  /// Index of a layer of a chosen block.
  [[nodiscard]] std::size_t index(Number block, int z) const {
    return std::size_t{chosen_.rank(block)} * 8 + static_cast<std::size_t>(z);
  }
  static std::uint64_t bit_of(const FineCell& cell) {
    return std::uint64_t{1} << (cell.y * 8 + cell.x);
  }
  RankedBits chosen_;
  std::vector<std::uint64_t> words_;  ///< Eight layers a chosen block, from below.
};

}  // namespace raymoval::dynamicmap
