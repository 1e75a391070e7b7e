// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "datasets/odometry/pose_graph.h"
#include "datasets/odometry/steps.h"

namespace raymoval::odometry {

/// Finds returns to a place: for each station along the path, the nearest earlier station within
/// the distance that odometry may have drifted since. The scan is registered to a map of the scans
/// around the earlier station, from several starts, and its motion is an edge if the match is good
/// and no other is about as good.
/// @param poses of the scans
/// @param times of the scans, seconds
/// @throws DataError if a scan cannot be read; Cancelled
std::vector<GraphEdge> find_loops(const MovingScans& input, const std::vector<Pose>& poses,
                                  const std::vector<double>& times);

}  // namespace raymoval::odometry
