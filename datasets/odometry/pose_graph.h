// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/scan/scan.h"

namespace raymoval::odometry {

/// Standard deviations of a motion.
struct MotionSigma {
  double metres = 0.01;
  double radians = 0.001;
};

/// A measured motion between two poses, or, without `from`, a measured pose.
struct GraphEdge {
  std::optional<std::size_t> from;
  std::size_t to = 0;
  Pose T_from_to = Pose::Identity();  ///< T_world_to without `from`.
  MotionSigma sigma;
  bool is_robust = false;  ///< Whether it may be wrong: it loses weight if it fits badly (Cauchy).
};

/// The poses that fit the edges best: least squares over SE(3) by Gauss-Newton, with a sparse LDLT
/// decomposition. Without an edge to the world, the first pose is fixed.
/// @param poses start values; every pose is connected with the first by edges
/// @throws InternalError if the edges do not determine the poses
std::vector<Pose> optimised(std::vector<Pose> poses, const std::vector<GraphEdge>& edges);

}  // namespace raymoval::odometry
