// SPDX-License-Identifier: MIT
#include "methods/raymoval/kernels/occupancy_map.h"

#include "core/parallel.h"

namespace raymoval::raymoval_method {
OccupancyMap::Slot OccupancyMap::make_brick(const Eigen::Vector3i& brick) {
  const auto next = static_cast<Slot>(bricks_.size());
  const auto [found, is_new] = index_.try_emplace(voxel_key(brick), next);
  if (!is_new) return found->second;
  const Eigen::Vector2i tile = tile_of(brick);
  const auto next_tile = static_cast<std::uint32_t>(tiles_.size());
  const auto [tile_at, is_new_tile] =
      tile_index_.try_emplace(voxel_key(tile.x(), tile.y(), 0), next_tile);
  if (is_new_tile) tiles_.emplace_back();
  std::vector<BrickHead>& heads = tiles_[tile_at->second];
  bricks_.emplace_back();
  boxes_.emplace_back();
  places_.push_back({tile_at->second, static_cast<std::uint32_t>(heads.size())});
  BrickHead& head = heads.emplace_back();
  head.at = {brick.x(), brick.y(), brick.z()};
  head.slot = next;
  return next;
}

bool OccupancyMap::erase(const VoxelIndex& voxel) {
  const Slot slot = find_slot(brick_of(voxel));
  if (slot == kNoBrick) return false;
  std::uint64_t& word = word_of(slot, voxel);
  const std::uint64_t bit = Brick::bit(voxel.y(), voxel.z());
  if ((word & bit) == 0) return false;
  mark_changed(slot);
  word &= ~bit;
  --size_;
  return true;
}

bool OccupancyMap::contains_near(const VoxelIndex& voxel, int dilation) const {
  const VoxelIndex low = voxel.array() - dilation, high = voxel.array() + dilation;
  const Eigen::Vector3i first = brick_of(low), last = brick_of(high);
  for (int z = first.z(); z <= last.z(); ++z) {
    for (int y = first.y(); y <= last.y(); ++y) {
      for (int x = first.x(); x <= last.x(); ++x) {
        const Brick* found = find_brick({x, y, z});
        if (found == nullptr) continue;
        const BrickPart part = BrickPart::within({x, y, z}, low, high);
        for (int word = part.first_word; word <= part.last_word; ++word) {
          if ((found->occupied[static_cast<std::size_t>(word)] & part.mask) != 0) return true;
        }
      }
    }
  }
  return false;
}

void OccupancyMap::update_boxes(int threads) {
  if (changed_.empty()) return;  // No writes: several threads may read the map.
  parallel_for(threads, changed_.size(), 32, [&](std::size_t i) {
    const Slot slot = changed_[i];
    cover_with_boxes(bricks_[slot], boxes_[slot]);
    Place& place = places_[slot];
    BrickHead& head = tiles_[place.tile][place.head];
    head.is_empty = boxes_[slot].empty();
    if (!head.is_empty) head.bounds = tight_box(bricks_[slot]);
    place.is_changed = false;
  });
  changed_.clear();
}

}  // namespace raymoval::raymoval_method
