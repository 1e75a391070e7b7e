// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "methods/raymoval/angular_grid.h"
#include "methods/raymoval/occupancy_map.h"

namespace raymoval {

/// A ray in the world frame (eq. 6): origin o = t, unit direction d = R u.
struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
};

/// Where a ray first meets the map.
struct FirstHit {
  double range;  ///< Distance at which the ray enters the voxel, metres.
  VoxelIndex voxel;
};

/// Eq. 7: the first occupied voxel along `ray` that is entered at a distance within
/// [minimum_range, maximum_range]; nothing if there is none. Exact: planes are never accumulated.
/// Voxels are half open, [k, k + 1) cells an axis.
std::optional<FirstHit> cast_ray(const OccupancyMap& map, const Ray& ray, double minimum_range,
                                 double maximum_range);

/// First hits for every bin of a grid.
struct FirstHitImage {
  std::vector<float> range;     ///< r_cast of each bin, metres; infinite where nothing is hit.
  std::vector<VoxelKey> voxel;  ///< Voxel hit; meaningless where `range` is infinite.
};

/// Eqs 4-7 for all bins of `grid` seen from `T_world_sensor`.
FirstHitImage cast_first_hits(const OccupancyMap& map, const Pose& T_world_sensor,
                              const AngularGrid& grid, double minimum_range, double maximum_range,
                              int threads);

}  // namespace raymoval
