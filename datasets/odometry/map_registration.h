// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/scan/scan.h"
#include "datasets/odometry/plane_map.h"

namespace raymoval::odometry {

/// The points of a scan, at the time of the scan, that registration uses. Sensor frame, metres.
struct ThinnedScan {
  std::vector<Eigen::Vector3f> dense;   ///< For the map: one per 0.4 cells.
  std::vector<Eigen::Vector3f> sparse;  ///< To be registered: at most 3,000.
};

/// The motion of the sensor while a scan is taken.
struct ScanMotion {
  std::vector<double> point_times;  ///< Seconds from the time of the scan; empty: no motion.
  Pose motion = Pose::Identity();   ///< T_before_after over `duration`.
  double duration = 0.0;            ///< Seconds.
};

/// Lengths that depend on the sensor and the place, metres.
struct ScanScale {
  double range = 0.0;  ///< Median of the points.
  double cell = 0.0;   ///< Edge of the smallest cells of a map.
};

/// The scale of a scan. Cells are larger if points are farther apart: strips of single rings on the
/// ground do not determine the pitch. @param scan with a point
ScanScale scale_of(const Scan& scan);

/// Points nearer than a quarter of the median range are left out, because they may be of the ego
/// vehicle, and points beyond 100 m, too.
ThinnedScan thinned(const Scan& scan, const ScanMotion& motion, const ScanScale& scale);

/// Distance from a prediction with constant velocity, metres, for scans this many seconds apart.
double usual_deviation(double period_s);

/// How a scan was registered.
struct Registered {
  Pose T_map_sensor = Pose::Identity();
  double overlap = 0.0;     ///< Share of the matched points that lie on the map, 0 to 1.
  double matched = 0.0;     ///< Share of the points that have a counterpart within two cells.
  bool determined = false;  ///< Whether the map determines the motion in all directions.

  [[nodiscard]] double fit() const { return overlap * matched; }
};

inline constexpr double kLeastReach = 0.15;  // metres

/// Registers points to a map. The distance to counterparts that is searched begins with `reach`,
/// and falls to `kLeastReach`.
Registered register_to_map(const PlaneMap& map, const std::vector<Eigen::Vector3f>& points,
                           const Pose& guess, double reach);

/// At most `most` of the points, evenly spread.
std::vector<Eigen::Vector3f> few_of(const std::vector<Eigen::Vector3f>& points, std::size_t most);

}  // namespace raymoval::odometry
