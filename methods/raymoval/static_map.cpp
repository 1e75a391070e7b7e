// SPDX-License-Identifier: MIT
#include "methods/raymoval/static_map.h"

namespace raymoval {

void StaticMap::integrate(Slot slot, const VoxelIndex& voxel) {
  if (was_erased(slot, voxel)) {
    if (permanent_erase_) return;
    erased_[erased_of_[slot]].occupied[static_cast<std::size_t>(voxel.x() & Brick::kMask)] &=
        ~Brick::bit(voxel.y(), voxel.z());
  }
  occupied_.insert(slot, voxel);
}

void StaticMap::integrate(const std::vector<VoxelIndex>& voxels, const std::vector<Slot>& slots,
                          const Mask& dynamic) {
  Eigen::Vector3i last = Eigen::Vector3i::Zero();
  Slot last_slot = OccupancyMap::kNoBrick;
  for (std::size_t k = 0; k < voxels.size(); ++k) {
    if (dynamic[k] != 0) continue;
    Slot slot = slots[k];
    if (slot == OccupancyMap::kNoBrick) {
      const Eigen::Vector3i brick = OccupancyMap::brick_of(voxels[k]);
      if (last_slot == OccupancyMap::kNoBrick || brick != last) {
        last = brick;
        last_slot = occupied_.make_brick(brick);
      }
      slot = last_slot;
    }
    integrate(slot, voxels[k]);
  }
}

void StaticMap::erase(const VoxelIndex& voxel) {
  if (!occupied_.erase(voxel)) return;
  const Slot slot = occupied_.find_slot(OccupancyMap::brick_of(voxel));
  if (slot >= erased_of_.size()) erased_of_.resize(occupied_.brick_count(), kNothingErased);
  if (erased_of_[slot] == kNothingErased) {
    erased_of_[slot] = static_cast<std::uint32_t>(erased_.size());
    erased_.emplace_back();
  }
  erased_[erased_of_[slot]].occupied[static_cast<std::size_t>(voxel.x() & Brick::kMask)] |=
      Brick::bit(voxel.y(), voxel.z());
}

}  // namespace raymoval
