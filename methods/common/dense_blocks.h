// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/scan/voxel_key.h"

namespace raymoval {

/// A grid without bounds. It consists of dense blocks of 2^`kBitsXY` x 2^`kBitsXY` x 2^`kBitsZ`
/// cells, which are found by a hash. The cells of a new block hold `empty`.
///
/// A `Cursor` stores the last used block, or that there is none. The points of a scan come ring by
/// ring, so the next point is mostly in the same block and needs no hash. Each thread has its own
/// cursor. A cursor must not be used again after another cursor has made a block.
template <class Value, int kBitsXY, int kBitsZ>
class DenseBlocks {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  static constexpr std::size_t kNoSlot = ~std::size_t{0};
  static constexpr int kSideXY = 1 << kBitsXY, kSideZ = 1 << kBitsZ;
  static constexpr std::size_t kCells = std::size_t{1} << (2 * kBitsXY + kBitsZ);

  struct Cursor {
    VoxelKey key = ~VoxelKey{0};
    std::uint32_t block = kNone;
  };

  explicit DenseBlocks(Value empty) : empty_(empty) {}

  static VoxelIndex block_of(const VoxelIndex& cell) {
    return {cell.x() >> kBitsXY, cell.y() >> kBitsXY, cell.z() >> kBitsZ};
  }
  /// The cell of this index within the block at the origin.
  static VoxelIndex cell_at(std::size_t offset) {
    const auto i = static_cast<int>(offset);
    return {i & (kSideXY - 1), i >> kBitsXY & (kSideXY - 1), i >> (2 * kBitsXY)};
  }
  /// The index of a cell within its block: x runs fastest, then y, then z.
  static std::size_t offset(const VoxelIndex& cell) {
    constexpr int kMaskXY = kSideXY - 1, kMaskZ = kSideZ - 1;
    return static_cast<std::size_t>(((cell.z() & kMaskZ) << (2 * kBitsXY)) |
                                    ((cell.y() & kMaskXY) << kBitsXY) | (cell.x() & kMaskXY));
  }

  /// The number of the block at these block indices, or `kNone` if there is none.
  [[nodiscard]] std::uint32_t block(const VoxelIndex& index) const {
    const auto found = numbers_.find(voxel_key(index));
    return found == numbers_.end() ? kNone : found->second;
  }
  /// Calls `visit(number)` with each block at most `reach` blocks from block `center` along each
  /// axis, itself included.
  template <class Visit>
  void for_blocks_around(std::uint32_t center, int reach, Visit&& visit) const {
    for (int z = -reach; z <= reach; ++z) {
      for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
          const std::uint32_t other = block(block_index(center) + VoxelIndex(x, y, z));
          if (other != kNone) visit(other);
        }
      }
    }
  }
  [[nodiscard]] std::size_t block_count() const { return indices_.size(); }
  [[nodiscard]] const VoxelIndex& block_index(std::uint32_t number) const {
    return indices_[number];
  }
  [[nodiscard]] const Value* cells(std::uint32_t number) const {
    return values_.data() + number * kCells;
  }

  /// The index of a cell among those of all blocks, or `kNoSlot` where there is no block.
  [[nodiscard]] std::size_t slot(const VoxelIndex& cell, Cursor& cursor) const {
    const VoxelKey key = voxel_key(block_of(cell));
    if (key != cursor.key) cursor = {key, block(block_of(cell))};
    return cursor.block == kNone ? kNoSlot : cursor.block * kCells + offset(cell);
  }
  [[nodiscard]] const Value& at(std::size_t slot) const { return values_[slot]; }
  [[nodiscard]] Value& at(std::size_t slot) { return values_[slot]; }
  /// The cell's value, or `empty` where there is no block.
  [[nodiscard]] Value get(const VoxelIndex& cell, Cursor& cursor) const {
    const std::size_t found = slot(cell, cursor);
    return found == kNoSlot ? empty_ : at(found);
  }
  /// The index of a cell, which is made if it does not exist. This may invalidate references from
  /// earlier calls.
  std::size_t make_slot(const VoxelIndex& cell, Cursor& cursor) {
    const VoxelIndex index = block_of(cell);
    const VoxelKey key = voxel_key(index);
    if (key != cursor.key || cursor.block == kNone) {
      const auto [found, fresh] = numbers_.emplace(key, static_cast<std::uint32_t>(block_count()));
      if (fresh) {
        indices_.push_back(index);
        values_.resize(values_.size() + kCells, empty_);
      }
      cursor = {key, found->second};
    }
    return cursor.block * kCells + offset(cell);
  }
  Value& make(const VoxelIndex& cell, Cursor& cursor) { return values_[make_slot(cell, cursor)]; }

 private:
  Value empty_;
  VoxelMap<std::uint32_t> numbers_;
  std::vector<VoxelIndex> indices_;
  std::vector<Value> values_;
};

}  // namespace raymoval
