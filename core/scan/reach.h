// SPDX-License-Identifier: MIT
#pragma once

#include "core/scan/voxel_key.h"

namespace raymoval {

// Largest distances. Methods and protocols fail on points or positions beyond them. Inspection
// reads the same numbers, so that it finds such data.

/// Extent of a lattice from its origin (see `method_frame` and `lattice_origin`) along an axis,
/// metres.
constexpr double lattice_reach(double voxel_size) {
  return kVoxelLimit * voxel_size;
}

/// Distance from the first scan that all methods and protocols support with their defaults, along
/// each axis of the frame of methods, metres. Their smallest voxels are of 0.05 m.
inline constexpr double kUsualReach = lattice_reach(0.05);

/// Largest distance of a point from its sensor, metres. No LiDAR on the ground reaches it, and
/// every method accepts it with its defaults.
inline constexpr double kFarthestReturn = 10000.0;

/// Coarsest resolution of the positions of a sensor, metres. Far from the world's origin, numbers
/// have a coarser resolution.
inline constexpr double kCoarsestPosition = 0.001;

}  // namespace raymoval
