// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "methods/raymoval/occupancy_map.h"
#include "methods/raymoval/validation.h"

namespace raymoval {

/// The map M of the paper with what it must remember: which voxels were seen through, and how many
/// points every observed voxel has had. Memory is bounded by the number of observed voxels.
class StaticMap {
 public:
  /// @param permanent_erase a voxel once seen through is never filled again
  StaticMap(double voxel_size, bool permanent_erase)
      : occupied_(voxel_size), permanent_erase_(permanent_erase) {}

  [[nodiscard]] const OccupancyMap& occupied() const { return occupied_; }
  [[nodiscard]] VoxelIndex voxel_of(const Eigen::Vector3d& world) const {
    return occupied_.voxel_of(world);
  }
  [[nodiscard]] bool was_erased(const VoxelIndex& voxel) const {
    return erased_.contains(voxel_key(voxel));
  }

  /// Counts points of a scan as observed; `voxels` has one entry per point.
  void observe(const std::vector<VoxelIndex>& voxels);
  /// Adds a static point's voxel, unless it was erased for good.
  void integrate(const VoxelIndex& voxel);
  /// Removes a voxel that a scan saw through.
  void erase(const VoxelIndex& voxel);
  /// Puts a voxel back that validation found to be static.
  void restore(const VoxelIndex& voxel);

  /// Observed voxels that are not in the map, sorted by key; position = voxel centre, weight =
  /// points observed in it.
  [[nodiscard]] WeightedPoints removed_voxels() const;

 private:
  OccupancyMap occupied_;
  bool permanent_erase_;
  VoxelSet erased_;
  VoxelMap<std::uint32_t> observed_;
};

}  // namespace raymoval
