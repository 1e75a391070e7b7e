// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "core/progress.h"
#include "core/scan/scan_source.h"
#include "datasets/odometry/map_registration.h"
#include "datasets/odometry/pose_graph.h"

namespace raymoval::odometry {

/// The scans of one sensor, and what is needed to estimate their poses.
struct MovingScans {
  const ScanSource& scans;  ///< Their poses are not used.
  /// The time of each point, seconds from the time of the scan. Null: points have no times.
  std::function<std::vector<double>(const Scan&)> point_times = nullptr;
  ScanScale scale = {};  ///< Of the scans.
  int threads = 1;
  Progress* progress = nullptr;
  const std::atomic<bool>* cancel = nullptr;
};

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
