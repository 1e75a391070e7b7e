// SPDX-License-Identifier: MIT
#pragma once

#include "methods/raymoval/occupancy_map.h"

namespace raymoval {

/// The map M of the paper with what it must remember: which voxels were seen
/// through. Memory is bounded by the number of observed voxels.
class StaticMap {
 public:
  /// @param permanent_erase a voxel once seen through is never filled again
  StaticMap(double voxel_size, bool permanent_erase)
      : occupied_(voxel_size), permanent_erase_(permanent_erase) {}

  [[nodiscard]] const OccupancyMap& occupied() const { return occupied_; }
  [[nodiscard]] OccupancyMap& occupied() { return occupied_; }
  [[nodiscard]] VoxelIndex voxel_of(const Eigen::Vector3d& world) const {
    return occupied_.voxel_of(world);
  }
  [[nodiscard]] bool was_erased(const VoxelIndex& voxel) const {
    return erased_.contains(voxel_key(voxel));
  }

  /// Adds a static point's voxel, unless it was erased for good.
  void integrate(const VoxelIndex& voxel);
  /// Removes a voxel that a scan saw through.
  void erase(const VoxelIndex& voxel);

 private:
  OccupancyMap occupied_;
  bool permanent_erase_;
  VoxelSet erased_;
};

}  // namespace raymoval
