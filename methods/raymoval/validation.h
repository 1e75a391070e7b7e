// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/scan.h"
#include "methods/raymoval/clusters.h"
#include "methods/raymoval/occupancy_map.h"
#include "methods/raymoval/parameters.h"

namespace raymoval {

/// A set of points with weights: points of a scan (each of weight 1) or removed voxels of the map
/// (each as heavy as it has points).
struct WeightedPoints {
  std::vector<Eigen::Vector3d> position;  ///< World, metres.
  std::vector<VoxelIndex> voxel;
  std::vector<double> weight;
  [[nodiscard]] std::size_t size() const { return position.size(); }
};

/// m(r) of eq. 13: points a cluster at range r needs, `cluster_points` at 10 m, falling with the
/// square of the range as the solid angle of an object does, at least 3.
double cluster_points_at(double range, const RaymovalParameters& parameters);

/// d(r) of eq. 13: width a cluster at range r needs, metres; the same at all ranges.
double cluster_width_at(double range, const RaymovalParameters& parameters);

/// Eqs 12-13: whether a cluster is large enough to be an object.
bool passes_cluster_screen(const std::vector<int>& members, const WeightedPoints& points,
                           const std::vector<double>& ranges, const RaymovalParameters& parameters);

/// Eq. 14: share of the weight of `members` that lies within `dilation` voxels of the static map.
double coverage(const std::vector<int>& members, const WeightedPoints& points,
                const OccupancyMap& static_map, int dilation);

/// Eq. 15: whether a group belongs to the static map after all. @param thinnest_side metres
bool belongs_to_static(double group_coverage, double thinnest_side,
                       const RaymovalParameters& parameters);

/// Spatial consistency validation of a scan's dynamic candidates (section 3 of the paper):
/// range-adaptive clustering, screens (12-13), groups of neighbouring clusters against the static
/// map (14-15), then in what stays dynamic only unsupported points, and no remainder smaller than
/// minimum_points or narrower than minimum_width.
/// @return 1 for each candidate that stays dynamic
Mask validate_candidates(const WeightedPoints& candidates, const std::vector<double>& ranges,
                         const OccupancyMap& static_map, const RaymovalParameters& parameters);

/// The same for the removed voxels of the whole map, where no range applies: clusters are voxels
/// that touch, groups are clusters within `group_gap` voxels.
Mask validate_removed_voxels(const WeightedPoints& voxels, const OccupancyMap& static_map,
                             const RaymovalParameters& parameters);

}  // namespace raymoval
