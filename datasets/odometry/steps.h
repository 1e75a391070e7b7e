// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/scan/scan_source.h"
#include "datasets/odometry/map_registration.h"

namespace raymoval::odometry {

/// The scans of one sensor whose poses are estimated, and how to read them.
struct MovingScans {
  const ScanSource& scans;  ///< Their poses are not used.
  /// The time of each point, seconds from the time of the scan. Null: points have no times.
  std::function<std::vector<double>(const Scan&)> point_times = nullptr;
  ScanScale scale = {};  ///< Of the scans.
  int threads = 1;
  Progress* progress = nullptr;
  const std::atomic<bool>* cancel = nullptr;
};

/// Scan `i`, with its points moved to its time by the motion from the scan before.
/// @param poses of all scans
/// @param times of all scans, seconds
/// @throws DataError if the scan cannot be read; Cancelled
ThinnedScan thinned(const MovingScans& input, const std::vector<Pose>& poses,
                    const std::vector<double>& times, std::size_t i);

inline constexpr double kLongGap = 1.0;  ///< Between two scans, seconds.

/// The result of odometry.
struct Steps {
  std::vector<Registered> scans;
  std::vector<double> times;
  std::vector<std::string> names;

  [[nodiscard]] std::vector<Pose> poses() const {
    std::vector<Pose> poses;
    for (const Registered& scan : scans) poses.push_back(scan.T_map_sensor);
    return poses;
  }
};

/// Whether a scan does not overlap with the scans before it.
bool is_lost(const Registered& scan);

/// How odometry begins, and over how many scans.
struct Course {
  std::size_t scans;
  std::optional<Pose> first_motion = std::nullopt;
  bool may_be_lost = false;  ///< Else a scan that does not overlap is an error.
};

/// Runs odometry over scans. Then the first four are registered again, to the scans after them:
/// at first, the map has few scans. Poses are relative to the first scan.
/// @param given null, or poses whose motions are a second guess
/// @throws DataError naming a scan that is lost; or if a scan cannot be read. Cancelled
Steps odometry_of(const MovingScans& input, const Course& course, const std::vector<Pose>* given);

}  // namespace raymoval::odometry
