// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/scan/scan.h"

namespace raymoval {

/// A plane n.p + d = 0 with a unit normal that does not point down.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset = 0.0;
  [[nodiscard]] double height_of(const Eigen::Vector3d& point) const {
    return normal.dot(point) + offset;
  }
};

/// A plane, with statistics of the points that it was fitted to.
struct PlaneFit {
  Plane plane;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< The points' mean.
  /// Variances of the points along their principal axes, ascending, of the population.
  Eigen::Vector3d variances = Eigen::Vector3d::Zero();
  double points = 0.0;  ///< Number of points.
};

/// Plane of least squared distance through those `points` that `chosen` marks (at least one). If
/// they do not span a plane, the plane through them with the most upright normal.
PlaneFit fit_plane(std::span<const Eigen::Vector3d> points, std::span<const std::uint8_t> chosen);

}  // namespace raymoval
