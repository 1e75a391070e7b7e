// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/scan/scan.h"
#include "methods/raymoval/kernels/occupancy_map.h"
#include "methods/raymoval/raymoval.h"

namespace raymoval::raymoval_method {

/// Axis-aligned bounding box of a set of points.
struct Extent {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300);
  Eigen::Vector3d high = Eigen::Vector3d::Constant(-1e300);
  void add(const Eigen::Vector3d& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  /// diam(C) of eq. 12: diagonal of the box seen from above, metres.
  [[nodiscard]] double width() const { return (high - low).head<2>().norm(); }
};

/// The component number of each voxel. Numbers begin at 0, in the order of the components' first
/// voxels. Two voxels are
/// joined if they lie within `gap` cells of each other (Chebyshev).
std::vector<int> voxel_components(const std::vector<VoxelKey>& voxels, int gap);

/// The group number of each element. Clusters that have elements in a common component are one
/// group, numbered by its lowest component.
std::vector<int> joined_groups(const std::vector<int>& cluster_of,
                               const std::vector<int>& component_of);

/// The members of each numbered set that has any. Sets and members are in ascending order.
std::vector<std::vector<int>> members_of(const std::vector<int>& numbers);

/// Points of one scan that are candidates for removal, one element per point.
struct ScanPoints {
  std::vector<Eigen::Vector3d> position;  ///< World, metres.
  std::vector<VoxelIndex> voxel;
  std::vector<double> range;  ///< The distance from the sensor, metres.
  [[nodiscard]] std::size_t size() const { return position.size(); }
};

/// m(r) of eq. 13: the number of points that a cluster at range r needs, at least 3. It is
/// `cluster_points` at 10 m and falls with the square of the range, like the solid angle of an
/// object.
double cluster_points_at(double range, const Parameters& parameters);

/// Eqs 12-13: whether a cluster is large enough to be an object. The required width d(r) is the
/// same at all ranges.
bool passes_cluster_screen(const std::vector<int>& members, const ScanPoints& points,
                           const Parameters& parameters);

/// Eq. 14: the share of `members` within `dilation` voxels of the static map.
double coverage(const std::vector<int>& members, const ScanPoints& points,
                const OccupancyMap& static_map, int dilation);

/// Eq. 15: whether a group belongs to the static map. @param thinnest_side metres
bool belongs_to_static(double group_coverage, double thinnest_side, const Parameters& parameters);

/// The share of static voxels among the static and the removed ones within `dilation` cells of
/// `voxel` (itself included). It is 0 if there are none.
double support(const VoxelIndex& voxel, const OccupancyMap& static_map, const OccupancyMap& removed,
               int dilation);

/// Members of a dynamic cluster that are not among static voxels: their support, with the cluster's
/// voxels as the removed ones, is below `support_share`.
std::vector<int> unsupported_members(const std::vector<int>& cluster, const ScanPoints& points,
                                     const OccupancyMap& static_map, const Parameters& parameters);

/// Spatial consistency validation of a scan's candidates (section 3 of the paper): range-adaptive
/// clusters, screens (12-13), groups of neighbouring clusters against the static map (14-15), then
/// only unsupported points stay dynamic, without remainders smaller than minimum_points or narrower
/// than minimum_width.
/// @return 1 for each candidate that stays dynamic
Mask validate_candidates(const ScanPoints& candidates, const OccupancyMap& static_map,
                         const Parameters& parameters);

}  // namespace raymoval::raymoval_method
