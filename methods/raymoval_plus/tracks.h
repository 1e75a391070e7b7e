// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "methods/raymoval_plus/parameters.h"

namespace raymoval {

/// A cluster of one scan as the tracks see it; world frame, metres.
struct ObjectSummary {
  Eigen::Vector3d low, high;  ///< Bounding box.
  Eigen::Vector3d center;     ///< Mean of the points.
  double range = 0.0;         ///< Distance of the centre from the sensor.
  int points = 0;
  int dynamic = 0;           ///< Points found dynamic.
  double agree_scans = 0.0;  ///< Mean number of scans that agree with the other points.

  [[nodiscard]] double width() const { return (high - low).head<2>().norm(); }
};

/// Objects of each scan that were seen moving before or after: 1 for each that a track of dynamic
/// clusters passes through, whose own rays do not say so. Followed forward and backward in time.
std::vector<std::vector<std::uint8_t>> objects_on_tracks(
    const std::vector<std::vector<ObjectSummary>>& scans, const RaymovalPlusParameters& parameters);

}  // namespace raymoval
