// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/scan/scan.h"

namespace raymoval::registration {

/// A point and the plane of its counterpart, in one frame.
struct Match {
  Eigen::Vector3d at, normal;
  double distance;      ///< From the plane, signed, metres.
  double weight = 1.0;  ///< Beside Tukey's.
};
using Matches = std::vector<Match>;

/// Standard deviation of the distances by their median, for a normal distribution; 0 without
/// matches.
double robust_deviation(const Matches& matches);

/// A step of a registration.
struct PlaneStep {
  Pose motion = Pose::Identity();  ///< Moves the points towards their planes.
  int determined = 0;              ///< Directions that the planes determine, 0 to 6.
};

/// One Gauss-Newton step of point to plane (Chen and Medioni 1992) with Tukey's weights, about the
/// centre of the matches. Rotations are scaled to the distance that they move points. Directions
/// that the planes do not determine are not changed.
/// @param cut distance at which the weight ends, metres
/// @param least_share of the weights that determines a direction
PlaneStep plane_step(const Matches& matches, double cut, double least_share = 0.01);

}  // namespace raymoval::registration
