// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "datasets/odometry/loops.h"

namespace raymoval::odometry {

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
  TriedMotion alike;  ///< The best of those that end like the given poses; it may be `given`.
  TriedMotion other;  ///< The best of those that do not; without overlap if there is none.

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

}  // namespace raymoval::odometry
