// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/scan/voxel_key.h"

namespace raymoval::dynablox_method {

// Voxels stand together in blocks of 16 x 16 x 16, which are made of level layers.
inline constexpr int kSideBits = 4;
inline constexpr int kSide = 1 << kSideBits;
inline constexpr int kLayer = kSide * kSide;

/// Block of a voxel: its indices divided by the block's side, rounded down.
inline VoxelIndex block_of(const VoxelIndex& voxel) {
  return {voxel.x() >> kSideBits, voxel.y() >> kSideBits, voxel.z() >> kSideBits};
}
/// Row of a voxel in its block, along x: z above y.
inline std::size_t row_of(const VoxelIndex& voxel) {
  return static_cast<std::size_t>((voxel.z() & (kSide - 1)) * kSide + (voxel.y() & (kSide - 1)));
}
/// Bit of a voxel in its row.
inline std::uint16_t bit_of(const VoxelIndex& voxel) {
  return static_cast<std::uint16_t>(1U << (voxel.x() & (kSide - 1)));
}

/// A bit for each voxel of a block, a word for each row along x.
using BlockBits = std::array<std::uint16_t, kLayer>;

/// A voxel's count of scans and the last scan in which it was occupied.
struct Occupation {
  std::uint16_t scans = 0;         ///< In which it was occupied without a longer break.
  std::int32_t last_occupied = 0;  ///< Position in the source.
};

/// What is known of 256 voxels at one height, x fastest: 14 bytes a voxel.
struct alignas(64) Layer {
  std::array<float, kLayer> distance{};              ///< Mean signed distance to a surface, metres.
  std::array<float, kLayer> weight{};                ///< Of that mean; 0 = never seen.
  std::array<std::int32_t, kLayer> last_occupied{};  ///< As in `Occupation`.
  std::array<std::uint16_t, kLayer> occupied_scans{};
};

struct Block {
  Block(const VoxelIndex& position, const Occupation& of_new) : at(position), unseen(of_new) {}

  /// @param voxel one of this block
  [[nodiscard]] bool is_ever_free(const VoxelIndex& voxel) const {
    return (ever_free[row_of(voxel)] & bit_of(voxel)) != 0;
  }

  VoxelIndex at;  ///< Block indices (see `block_of`).
  /// Null until a voxel of the layer was seen. Till then all voxels of it are as `unseen`.
  std::array<std::unique_ptr<Layer>, kSide> layers;
  Occupation unseen;
  BlockBits ever_free{};
  /// Voxels that were seen, and not occupied within the burn-in, as of the scan `settled_at`.
  BlockBits settled{};
  std::int32_t settled_at = -1;
};

/// All blocks, numbered in the order in which they were made.
class BlockMap {
 public:
  /// The block at these block indices, or null.
  [[nodiscard]] Block* find(const VoxelIndex& at) {
    const auto found = numbers_.find(voxel_key(at));
    return found == numbers_.end() ? nullptr : blocks_[found->second].get();
  }
  [[nodiscard]] const Block* find(const VoxelIndex& at) const {
    return const_cast<BlockMap*>(this)->find(at);
  }
  /// The same; if there is none yet, it is made, of voxels that are as `of_new` says.
  Block& find_or_make(const VoxelIndex& at, const Occupation& of_new);

 private:
  VoxelMap<std::uint32_t> numbers_;
  std::vector<std::unique_ptr<Block>> blocks_;
};

/// Finds the blocks of voxels one after the other, most of which are in the block of the last one.
template <class Map, class Found>
class LastBlock {
 public:
  explicit LastBlock(Map& map) : map_(map) {}
  Found* find(const VoxelIndex& at) {
    if (!known_ || at != at_) {
      found_ = map_.find(at);
      at_ = at;
      known_ = true;
    }
    return found_;
  }

 private:
  Map& map_;
  VoxelIndex at_ = VoxelIndex::Zero();
  bool known_ = false;
  Found* found_ = nullptr;
};

}  // namespace raymoval::dynablox_method
