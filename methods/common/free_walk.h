// SPDX-License-Identifier: MIT
#pragma once

#include "methods/common/scan_grid.h"

namespace raymoval::scan_grid {

/// Marks the voxels that beams of one scan pass through.
class FreeWalk {
 public:
  /// Longest beam, in voxels.
  static constexpr double kLongest = 1 << 17;

  /// @param sensor world position in voxels
  /// @param pass_through_hits beams do not end at hits
  /// @param grid holds the hits of the scan
  FreeWalk(const Eigen::Vector3d& sensor, bool pass_through_hits, ScanGrid& grid);

  /// Marks the voxels of a beam up to and including the first hit, if it enters one.
  /// @param direction of unit length
  /// @param length of the beam in voxels, at most `kLongest`
  /// @return the last voxel marked
  VoxelIndex mark_free(const Eigen::Vector3d& direction, double length);

 private:
  std::uint64_t stopping_hits_;  ///< The hits of a column that end a beam: all or none.
  ScanGrid& grid_;
  VoxelIndex sensor_block_;
  Eigen::Vector3d sensor_;  ///< Voxels from the low corner of the sensor's block.
};

}  // namespace raymoval::scan_grid
