// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/scan/scan.h"

namespace raymoval::simulated {

/// Errors of a good LiDAR odometry with loop closures, at severity 1: a drift of a few centimetres
/// and hundredths of degrees that changes over some seconds, and a jitter from scan to scan.
struct PoseNoise {
  double drift_m = 0.03;  ///< Standard deviation on each axis (half of it upwards).
  double drift_deg = 0.03;
  double drift_time_s = 5.0;  ///< Correlation time of the drift.
  double jitter_m = 0.005;
  double jitter_deg = 0.008;
};

/// Error motions E of `count` scans: the reported pose is T_world_sensor * E. A severity of 0 gives
/// exact identities; the first drift is 0.
std::vector<Pose> pose_errors(const PoseNoise& noise, double severity, std::size_t count,
                              double period_s, std::uint64_t seed);

}  // namespace raymoval::simulated
