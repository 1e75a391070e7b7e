// SPDX-License-Identifier: MIT
#include "methods/peopleremover/answer.h"

namespace raymoval::peopleremover_method {

Mask ScanVerdicts::of(const LatticeScan& scan, std::size_t scan_points) {
  own_freed_.clear();
  halo_.clear();
  for (std::size_t k = 0; k < scan.size(); ++k) {
    const VoxelIndex& voxel = scan.voxels[k];
    const BrickId brick = finder_.find(brick_of(voxel));
    const BrickWord bit = voxel_bit(voxel);
    if ((freed_[brick] & bit & ~own_freed_.at(brick)) == 0) continue;
    own_freed_.set(brick, bit);
    // Freed voxels of the halo are dynamic by themselves: including them changes nothing.
    for_each_brick_near(finder_, voxel, radius_,
                        [this](BrickId near, BrickWord voxels) { halo_.set(near, voxels); });
  }
  Mask dynamic(scan_points, 0);
  for (std::size_t k = 0; k < scan.size(); ++k) {
    const BrickId brick = finder_.find(brick_of(scan.voxels[k]));
    const BrickWord bit = voxel_bit(scan.voxels[k]);
    dynamic[scan.index[k]] = (halo_.at(brick) & bit) != 0 ? 1 : 0;
  }
  return dynamic;
}

}  // namespace raymoval::peopleremover_method
