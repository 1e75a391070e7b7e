// SPDX-License-Identifier: MIT
#include "methods/raymoval/occupancy_map.h"

namespace raymoval {

bool OccupancyMap::insert(const VoxelIndex& voxel) {
  const auto next = static_cast<std::uint32_t>(bricks_.size());
  const auto [found, is_new] = index_.try_emplace(voxel_key(brick_of(voxel)), next);
  if (is_new) {
    bricks_.emplace_back();
    lowest_brick_ = lowest_brick_.cwiseMin(brick_of(voxel));
    highest_brick_ = highest_brick_.cwiseMax(brick_of(voxel));
  }
  std::uint64_t& word = bricks_[found->second].occupied[static_cast<std::size_t>(voxel.x() & 7)];
  const std::uint64_t bit = std::uint64_t{1} << Brick::bit(voxel.y(), voxel.z());
  if ((word & bit) != 0) return false;
  word |= bit;
  ++size_;
  return true;
}

bool OccupancyMap::erase(const VoxelIndex& voxel) {
  const auto found = index_.find(voxel_key(brick_of(voxel)));
  if (found == index_.end()) return false;
  std::uint64_t& word = bricks_[found->second].occupied[static_cast<std::size_t>(voxel.x() & 7)];
  const std::uint64_t bit = std::uint64_t{1} << Brick::bit(voxel.y(), voxel.z());
  if ((word & bit) == 0) return false;
  word &= ~bit;
  --size_;
  return true;
}

bool OccupancyMap::contains_near(const VoxelIndex& voxel, int dilation) const {
  if (contains(voxel)) return true;
  for (int dz = -dilation; dz <= dilation; ++dz) {
    for (int dy = -dilation; dy <= dilation; ++dy) {
      for (int dx = -dilation; dx <= dilation; ++dx) {
        if (contains(voxel + VoxelIndex(dx, dy, dz))) return true;
      }
    }
  }
  return false;
}

}  // namespace raymoval
