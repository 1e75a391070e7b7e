// SPDX-License-Identifier: MIT
#include "methods/raymoval/static_map.h"

#include "core/parallel.h"
#include "hwy/cache_control.h"

namespace raymoval::raymoval_method {

void StaticMap::look_up(const std::vector<VoxelIndex>& voxels, int threads,
                        VoxelLookup& found) const {
  found.slots.resize(voxels.size());
  found.states.resize(voxels.size());
  constexpr std::size_t kGrain = 4096, kPiece = 256;
  parallel_chunks(threads, voxels.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    // The bricks of some voxels are prefetched before they are read.
    for (std::size_t piece = begin; piece < end; piece += kPiece) {
      const std::size_t last = std::min(piece + kPiece, end);
      find_slots(voxels, piece, last, found.slots);
      for (std::size_t k = piece; k < last; ++k) found.states[k] = state(found.slots[k], voxels[k]);
    }
  });
}

void StaticMap::find_slots(const std::vector<VoxelIndex>& voxels, std::size_t begin,
                           std::size_t end, std::vector<Slot>& slots) const {
  Eigen::Vector3i last = OccupancyMap::brick_of(voxels[begin]);
  last.x() += 1;  // Differs from the first voxel.
  Slot slot = OccupancyMap::kNoBrick;
  for (std::size_t k = begin; k < end; ++k) {
    const Eigen::Vector3i brick = OccupancyMap::brick_of(voxels[k]);
    if (brick != last) {
      last = brick;
      slot = occupied_.find_slot(brick);
      if (slot != OccupancyMap::kNoBrick) hwy::Prefetch(&occupied_.brick(slot));
      if (slot < erased_of_.size()) hwy::Prefetch(&erased_of_[slot]);
    }
    slots[k] = slot;
  }
}

VoxelState StaticMap::state(Slot slot, const VoxelIndex& voxel) const {
  if (slot == OccupancyMap::kNoBrick) return VoxelState::kEmpty;
  if (occupied_.brick(slot).contains(voxel.x(), voxel.y(), voxel.z())) return VoxelState::kOccupied;
  return was_erased(slot, voxel) ? VoxelState::kErased : VoxelState::kEmpty;
}

void StaticMap::integrate(Slot slot, const VoxelIndex& voxel) {
  if (!was_erased(slot, voxel)) occupied_.insert(slot, voxel);
}

void StaticMap::integrate(const std::vector<VoxelIndex>& voxels, const VoxelLookup& found,
                          const Mask& dynamic) {
  Eigen::Vector3i last = Eigen::Vector3i::Zero();
  Slot last_slot = OccupancyMap::kNoBrick;
  const VoxelIndex* present = nullptr;  // Neighbours often share a voxel.
  for (std::size_t k = 0; k < voxels.size(); ++k) {
    if (dynamic[k] != 0 || found.states[k] != VoxelState::kEmpty) continue;
    if (present != nullptr && voxels[k] == *present) continue;
    present = &voxels[k];
    Slot slot = found.slots[k];
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

void StaticMap::integrate(const std::vector<VoxelIndex>& voxels) {
  Eigen::Vector3i last = Eigen::Vector3i::Zero();
  Slot slot = OccupancyMap::kNoBrick;
  for (const VoxelIndex& voxel : voxels) {
    const Eigen::Vector3i brick = OccupancyMap::brick_of(voxel);
    if (slot == OccupancyMap::kNoBrick || brick != last) {
      last = brick;
      slot = occupied_.make_brick(brick);
    }
    integrate(slot, voxel);
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

}  // namespace raymoval::raymoval_method
