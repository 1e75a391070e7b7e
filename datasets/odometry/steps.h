// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/scan/scan_source.h"
#include "datasets/odometry/map_registration.h"
#include "datasets/odometry/pose_graph.h"

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

/// A motion from scan to scan, and how well some scans fit each other under it.
struct TriedMotion {
  Pose first = Pose::Identity(), last = Pose::Identity();  ///< T_before_after of two scans each.
  double overlap = 0.0, matched = 0.0;                     ///< Means, see `Registered`.

  /// Whether both end with the same motion.
  [[nodiscard]] bool is_like(const TriedMotion& other) const;
};

/// Scans that a search uses.
inline constexpr std::size_t kSearchedScans = 10;

struct MotionSearch {
  TriedMotion given;  ///< Of the given poses.
  TriedMotion alike;  ///< The best motion that ends like the given poses; it may be `given`.
  TriedMotion other;  ///< The best motion that ends elsewhere; without overlap if there is none.

  /// Advantage of the other motion, as a difference of overlaps.
  [[nodiscard]] double advantage() const { return other.overlap - given.overlap; }
};

/// Tries other motions than those of given poses on `kSearchedScans` scans. Vehicles that move at
/// the speed of the sensor fit a sensor at rest, and rings on the ground fit any motion. But only
/// under the right motion all static surfaces stay in place, so that the scans lie on their common
/// map with the largest overlap. Motions are tried along the direction that the surfaces determine
/// least, up to 45 m/s.
/// @param begin position of the first scan
/// @param poses of the scans from `begin` on, at least three
/// @throws DataError if a scan cannot be read; Cancelled
MotionSearch search_motion(const MovingScans& input, std::size_t begin,
                           const std::vector<Pose>& poses);

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
