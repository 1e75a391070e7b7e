// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <utility>

#include "core/scan/voxel_key.h"

namespace raymoval {

/// Blocks of voxels anywhere, found by a hash of their indices. A block never moves in memory, so
/// that each thread may work on its own block. For values in one array see `DenseBlocks`, for the
/// voxels of one scan `scan_grid::ScanGrid`.
template <class Block>
class SparseBlocks {
 public:
  /// The block at these block indices, or null.
  [[nodiscard]] Block* find(const VoxelIndex& at) const {
    const auto found = blocks_.find(voxel_key(at));
    return found == blocks_.end() ? nullptr : found->second.get();
  }
  /// The same; a missing block is made of `values`.
  template <class... Values>
  Block& find_or_make(const VoxelIndex& at, const Values&... values) {
    const auto [found, is_new] = blocks_.try_emplace(voxel_key(at));
    if (is_new) found.value() = std::make_unique<Block>(values...);
    return *found->second;
  }
  /// Calls `visit(block)` with each block, in no particular order.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (const auto& [key, block] : blocks_) visit(*block);
  }
  /// Removes the blocks for which `is_gone(block)`.
  template <class IsGone>
  void erase_if(IsGone&& is_gone) {
    VoxelMap<std::unique_ptr<Block>> kept;
    for (auto entry = blocks_.begin(); entry != blocks_.end(); ++entry) {
      if (!is_gone(*entry.value())) kept.emplace(entry.key(), std::move(entry.value()));
    }
    blocks_ = std::move(kept);
  }
  void clear() { blocks_.clear(); }

 private:
  VoxelMap<std::unique_ptr<Block>> blocks_;
};

/// Finds blocks in a constant map. Points come ring by ring, so that the last block is mostly
/// needed again, without a hash.
template <class Map>
class BlockFinder {
 public:
  explicit BlockFinder(const Map& map) : map_(map), found_(map.find(at_)) {}

  /// The block at these block indices, or null.
  auto find(const VoxelIndex& at) {
    if (at != at_) {
      found_ = map_.find(at);
      at_ = at;
    }
    return found_;
  }

 private:
  const Map& map_;
  VoxelIndex at_ = VoxelIndex::Zero();
  decltype(std::declval<const Map&>().find(VoxelIndex())) found_;
};

/// Calls `visit(index)` with the indices at most `reach` from `center` along each axis, itself
/// included; x runs fastest, then y, then z.
template <class Visit>
void for_each_around(const VoxelIndex& center, int reach, Visit&& visit) {
  for (int z = -reach; z <= reach; ++z) {
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) visit(VoxelIndex(center + VoxelIndex(x, y, z)));
    }
  }
}

}  // namespace raymoval
