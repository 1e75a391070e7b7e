// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/scan/scan.h"
#include "methods/erasor/parameters.h"

namespace raymoval::erasor_method {

/// A plane n.p + d = 0 with a unit normal that does not point down.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset = 0.0;
  [[nodiscard]] double height_of(const Eigen::Vector3d& point) const {
    return normal.dot(point) + offset;
  }
};

/// Plane of least squared distance through those `points` that `chosen` marks (at least one). If
/// they do not span a plane, the most upright one through them.
Plane fit_plane(const std::vector<Eigen::Vector3d>& points, const Mask& chosen);

/// R-GPF (region-wise ground plane fitting): which of a bin's map points are ground. `points` are
/// in the body frame, metres. All of them if there is nothing to start from.
/// @return 1 = ground, 0 = above it
Mask find_ground(const std::vector<Eigen::Vector3d>& points, const Parameters& parameters);

}  // namespace raymoval::erasor_method
