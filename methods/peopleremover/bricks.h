// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "core/scan/cell_set.h"

namespace raymoval::peopleremover_method {

/// A brick is 4 x 4 x 4 voxels, one bit each: bit = x + 4 y + 16 z.
inline constexpr int kBrickBits = 2;
inline constexpr int kBrickSide = 1 << kBrickBits;
/// A block is 8 x 8 x 8 bricks.
inline constexpr int kBlockBits = 3;

using BrickWord = std::uint64_t;
using BrickIndex = Eigen::Vector3i;
/// Number of a brick in a BrickMap; kNoBrick if the map has no such brick.
using BrickId = std::uint32_t;
inline constexpr BrickId kNoBrick = 0xFFFFFFFFU;

inline BrickIndex brick_of(const VoxelIndex& voxel) {
  return {voxel.x() >> kBrickBits, voxel.y() >> kBrickBits, voxel.z() >> kBrickBits};
}

inline BrickWord voxel_bit(int x, int y, int z) {
  return BrickWord{1} << ((x & 3) | ((y & 3) << 2) | ((z & 3) << 4));
}
inline BrickWord voxel_bit(const VoxelIndex& voxel) {
  return voxel_bit(voxel.x(), voxel.y(), voxel.z());
}

/// Voxel of bit `bit` of the brick `brick`.
inline VoxelIndex voxel_of_bit(const BrickIndex& brick, int bit) {
  return {brick.x() * kBrickSide + (bit & 3), brick.y() * kBrickSide + ((bit >> 2) & 3),
          brick.z() * kBrickSide + (bit >> 4)};
}

/// Bits of the voxels with local coordinates `low` to `high` (each 0 to 3) along one axis.
struct SlabMasks {
  std::array<std::array<std::array<BrickWord, 4>, 4>, 3> of;  ///< [axis][low][high]
};
const SlabMasks& slab_masks();

/// The occupied voxels of all scans: bricks numbered 0 .. size() - 1, found through blocks. Memory
/// depends on the occupied volume only, about 40 bytes per brick.
class BrickMap {
 public:
  /// A block marks its existing bricks, which have consecutive numbers.
  struct Block {
    std::array<std::uint64_t, 8> present{};  ///< Word = z, bit = x + 8 y.
    std::array<std::uint16_t, 8> before{};   ///< Number of bricks in earlier words.
    BrickId first = 0;

    [[nodiscard]] BrickId find(int brick_x, int brick_y, int brick_z) const {
      const auto word = static_cast<std::size_t>(brick_z & 7);
      const std::uint64_t bit = std::uint64_t{1} << ((brick_x & 7) | ((brick_y & 7) << 3));
      if ((present[word] & bit) == 0) return kNoBrick;
      return first + before[word] + static_cast<BrickId>(std::popcount(present[word] & (bit - 1)));
    }
  };

  explicit BrickMap(const CellSet& voxels);

  [[nodiscard]] std::size_t size() const { return occupied_.size(); }
  [[nodiscard]] BrickWord occupied(BrickId brick) const { return occupied_[brick]; }
  [[nodiscard]] BrickIndex index_of(BrickId brick) const { return voxel_index(keys_[brick]); }
  /// The block with this key (brick coordinates / 8, rounded down), or null.
  [[nodiscard]] const Block* find_block(VoxelKey block) const {
    const auto found = block_of_.find(block);
    return found == block_of_.end() ? nullptr : &blocks_[found->second];
  }

 private:
  std::vector<BrickWord> occupied_;
  std::vector<VoxelKey> keys_;
  std::vector<Block> blocks_;
  VoxelMap<std::uint32_t> block_of_;
};

/// Finds bricks quickly if look-ups are near each other. Each thread needs its own object.
class BrickFinder {
 public:
  explicit BrickFinder(const BrickMap& map) : map_(&map), slots_(kSlots) {}

  [[nodiscard]] BrickId find(int brick_x, int brick_y, int brick_z) {
    const BrickMap::Block* block =
        find_block(brick_x >> kBlockBits, brick_y >> kBlockBits, brick_z >> kBlockBits);
    return block == nullptr ? kNoBrick : block->find(brick_x, brick_y, brick_z);
  }
  [[nodiscard]] BrickId find(const BrickIndex& brick) {
    return find(brick.x(), brick.y(), brick.z());
  }
  /// The block with these block coordinates, or null.
  [[nodiscard]] const BrickMap::Block* find_block(int x, int y, int z) {
    const VoxelKey key = voxel_key(x, y, z);
    Slot& slot = slots_[static_cast<std::size_t>((x & 31) | ((y & 31) << 5) | ((z & 3) << 10))];
    if (slot.key != key) slot = {key, map_->find_block(key)};
    return slot.block;
  }

 private:
  static constexpr std::size_t kSlots = 4096;
  struct Slot {
    VoxelKey key = ~VoxelKey{0};
    const BrickMap::Block* block = nullptr;
  };
  const BrickMap* map_;
  std::vector<Slot> slots_;
};

/// Calls `visit(brick, bits)` for each brick of the map that the cube of voxels within `radius`
/// (Chebyshev) of `voxel` reaches; `bits` are the cube's voxels in that brick.
template <class Visit>
void for_each_brick_near(BrickFinder& finder, const VoxelIndex& voxel, int radius, Visit&& visit) {
  const VoxelIndex low = voxel.array() - radius, high = voxel.array() + radius;
  const BrickIndex first = brick_of(low), last = brick_of(high);
  const auto slab = [&](std::size_t axis, int brick) {
    const auto a = static_cast<Eigen::Index>(axis);
    const int from = std::max(low[a] - brick * kBrickSide, 0);
    const int to = std::min(high[a] - brick * kBrickSide, kBrickSide - 1);
    return slab_masks().of[axis][static_cast<std::size_t>(from)][static_cast<std::size_t>(to)];
  };
  for (int z = first.z(); z <= last.z(); ++z) {
    for (int y = first.y(); y <= last.y(); ++y) {
      for (int x = first.x(); x <= last.x(); ++x) {
        const BrickId brick = finder.find(x, y, z);
        if (brick != kNoBrick) visit(brick, slab(0, x) & slab(1, y) & slab(2, z));
      }
    }
  }
}

/// Step 2.8: clears the voxels of 26-connected components of fewer than `minimum` freed voxels.
/// @param freed one word per brick of `map`
void discard_small_clusters(const BrickMap& map, int minimum, std::vector<BrickWord>& freed);

}  // namespace raymoval::peopleremover_method
