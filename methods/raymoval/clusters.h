// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/scan/voxel_key.h"

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
  /// Shortest of the three sides, metres (eq. 15).
  [[nodiscard]] double thinnest_side() const { return (high - low).minCoeff(); }
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

}  // namespace raymoval::raymoval_method
