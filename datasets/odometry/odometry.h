// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/scan/scan.h"
#include "datasets/odometry/map_registration.h"
#include "datasets/odometry/plane_map.h"

namespace raymoval::odometry {

/// Odometry from the scans of one LiDAR, after the description of KISS-ICP (Vizzo et al. 2023): the
/// motion is predicted with constant velocity, points are moved to the time of the scan with it,
/// and the scan is registered to a local map, within a threshold that follows the errors of earlier
/// predictions. Unlike the map of KISS-ICP, this one has planes (see `PlaneMap`).
class Odometry {
 public:
  /// @param first_motion from the first scan to the second, if it is known to half a metre
  explicit Odometry(const ScanScale& scale, const std::optional<Pose>& first_motion = std::nullopt);

  /// Registers the next scan to the scans before. The pose is relative to the first scan.
  /// @param point_times of each point, seconds from the time of the scan; empty: no motion within
  ///   the scan
  /// @param hint a guess of the motion from the scan before, T_before_now, beside the prediction
  Registered add(const Scan& scan, std::vector<double> point_times = {},
                 const std::optional<Pose>& hint = std::nullopt);

 private:
  [[nodiscard]] Pose predicted(double time_s) const;
  /// The best result of registration from each guess; the first is the prediction.
  [[nodiscard]] Registered registered(const ThinnedScan& thin,
                                      const std::vector<Pose>& guesses) const;
  /// The pose up to 6 m from `guess` in plan at which points without a plane are nearest to others.
  [[nodiscard]] Pose searched(const std::vector<Eigen::Vector3f>& points, const Pose& guess) const;
  /// Registers again, also from turned guesses, and returns the best result.
  [[nodiscard]] Registered again(const std::vector<Eigen::Vector3f>& points, const Pose& guess,
                                 const Registered& found, double reach) const;
  [[nodiscard]] double threshold() const;
  void learn(const Pose& deviation);
  void extend(const ThinnedScan& thin, const Pose& T_map_sensor, double time_s);

  ScanScale scale_;
  std::optional<Pose> first_motion_;
  PlaneMap map_;
  std::vector<Pose> poses_;    ///< The last two.
  std::vector<double> times_;  ///< Of `poses_`, seconds.
  double squares_ = 0.0;       ///< Of the deviations from predictions, square metres.
  int deviations_ = 0;
  double usual_fit_ = 0.0;
  Eigen::Vector3d forgot_at_ = Eigen::Vector3d::Zero();
};

}  // namespace raymoval::odometry
