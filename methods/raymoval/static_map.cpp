// SPDX-License-Identifier: MIT
#include "methods/raymoval/static_map.h"

namespace raymoval {

void StaticMap::integrate(const VoxelIndex& voxel) {
  if (permanent_erase_ && was_erased(voxel)) return;
  if (occupied_.insert(voxel) && !permanent_erase_) erased_.erase(voxel_key(voxel));
}

void StaticMap::erase(const VoxelIndex& voxel) {
  if (occupied_.erase(voxel)) erased_.insert(voxel_key(voxel));
}

}  // namespace raymoval
