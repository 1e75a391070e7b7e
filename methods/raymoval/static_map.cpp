// SPDX-License-Identifier: MIT
#include "methods/raymoval/static_map.h"

#include <algorithm>

namespace raymoval {

void StaticMap::observe(const std::vector<VoxelIndex>& voxels) {
  for (const VoxelIndex& voxel : voxels) ++observed_[voxel_key(voxel)];
}

void StaticMap::integrate(const VoxelIndex& voxel) {
  if (permanent_erase_ && was_erased(voxel)) return;
  if (occupied_.insert(voxel) && !permanent_erase_) erased_.erase(voxel_key(voxel));
}

void StaticMap::erase(const VoxelIndex& voxel) {
  if (occupied_.erase(voxel)) erased_.insert(voxel_key(voxel));
}

void StaticMap::restore(const VoxelIndex& voxel) {
  erased_.erase(voxel_key(voxel));
  occupied_.insert(voxel);
}

WeightedPoints StaticMap::removed_voxels() const {
  std::vector<std::pair<VoxelKey, std::uint32_t>> removed;
  for (const auto& [key, count] : observed_) {
    if (!occupied_.contains(voxel_index(key))) removed.emplace_back(key, count);
  }
  std::sort(removed.begin(), removed.end());
  WeightedPoints voxels;
  for (const auto& [key, count] : removed) {
    const VoxelIndex voxel = voxel_index(key);
    voxels.voxel.push_back(voxel);
    voxels.position.emplace_back((voxel.cast<double>().array() + 0.5) * occupied_.voxel_size());
    voxels.weight.push_back(count);
  }
  return voxels;
}

}  // namespace raymoval
