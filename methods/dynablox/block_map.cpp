// SPDX-License-Identifier: MIT
#include "methods/dynablox/block_map.h"

namespace raymoval::dynablox_method {

Block& BlockMap::find_or_make(const VoxelIndex& at, const Occupation& of_new) {
  const auto [found, is_new] =
      numbers_.try_emplace(voxel_key(at), static_cast<std::uint32_t>(blocks_.size()));
  if (is_new) blocks_.push_back(std::make_unique<Block>(at, of_new));
  return *blocks_[found->second];
}

}  // namespace raymoval::dynablox_method
