// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "datasets/odometry/steps.h"

namespace raymoval::odometry {

/// Estimated poses, and what the user should know about them.
struct PoseEstimate {
  std::vector<Pose> poses;            ///< T_world_sensor of each scan.
  std::string summary;                ///< What was done, as a sentence; empty if nothing was.
  std::vector<std::string> warnings;  ///< Whole sentences.
  std::vector<std::string> doubts;    ///< Reasons why they may be wrong, each as a clause.
  std::size_t loops = 0;              ///< Returns to a place that were used.
};

/// Estimates the poses of scans from the scans alone: odometry (see `Odometry`), then a pose graph
/// with the returns to a place (see `find_loops`). The first scan's frame is the world frame.
/// @param input `scale` may be 0: it is taken from the middle scan
/// @throws DataError naming the scan that does not overlap with the scans before it, or the scans
///   whose motion is uncertain if they are more than 40 %, and remedies; or if a scan cannot be
///   read. Cancelled
PoseEstimate estimate_poses(MovingScans input);

/// Improves given poses: odometry with them as a second guess, then a pose graph with the returns
/// to a place, and with the given poses as measurements with small weights. They replace odometry
/// where it fails. The given poses remain if the result fits worse (see `measure_pose_fit`).
/// @param given one for each scan
/// @throws DataError if a scan cannot be read; Cancelled
PoseEstimate refine_poses(MovingScans input, const std::vector<Pose>& given);

}  // namespace raymoval::odometry
