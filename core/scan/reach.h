// SPDX-License-Identifier: MIT
#pragma once

#include "core/scan/voxel_key.h"

namespace raymoval {

// Largest distances. Methods and protocols fail on points or positions beyond them. Inspection
// reads the same numbers, so that it finds such data.

/// How far from the origin of a lattice (see `method_frame` and `lattice_origin`) its voxels reach
/// along an axis, metres.
constexpr double lattice_reach(double voxel_size) {
  return kVoxelLimit * voxel_size;
}

/// How far from the first scan all methods and protocols reach with their defaults along each axis
/// of the frame that methods run in, metres. The smallest of their voxels are of 0.05 m.
inline constexpr double kUsualReach = lattice_reach(0.05);

/// Largest distance of a point from its sensor, metres. No LiDAR on the ground reaches it, and
/// every method accepts it with its defaults.
inline constexpr double kFarthestReturn = 10000.0;

/// How large the steps between neighbouring positions of a sensor may be, metres. Far from the
/// world's origin the numbers that hold them are coarser.
inline constexpr double kCoarsestPosition = 0.001;

}  // namespace raymoval
