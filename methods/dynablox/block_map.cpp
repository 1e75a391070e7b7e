// SPDX-License-Identifier: MIT
#include "methods/dynablox/block_map.h"

namespace raymoval::dynablox_method {

Block& BlockMap::find_or_make(const VoxelIndex& at, std::int32_t scan) {
  const auto [found, is_new] =
      numbers_.try_emplace(voxel_key(at), static_cast<std::uint32_t>(blocks_.size()));
  if (is_new) {
    blocks_.push_back(std::make_unique<Block>(at));
    blocks_.back()->unseen = {.scans = 1, .last_occupied = scan};
  }
  return *blocks_[found->second];
}

}  // namespace raymoval::dynablox_method
