// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "datasets/simulation/world/mover.h"

namespace raymoval::simulated {

/// Angles of an excavator at one instant, radians.
struct ArmAngles {
  double swing;   ///< Of the upper carriage about the vertical.
  double boom;    ///< Above the horizontal, at its foot.
  double stick;   ///< Against the boom.
  double bucket;  ///< Against the stick.
};

/// Angles `phase` (0 .. 1) of the way through dig, lift, swing, dump and swing back.
ArmAngles dig_cycle(double phase);

/// What carries the sensor: where it is, how it shakes, and what of itself the sensor sees.
class Ego {
 public:
  Ego(const EgoSpec& spec, const Ground& ground);

  /// True `T_world_sensor`.
  [[nodiscard]] Eigen::Isometry3d sensor_pose(double time) const;
  /// The vehicle's own surfaces (label 1) and, of an excavator, its moving arm (label 259).
  void place(double time, std::vector<PlacedPart>& parts) const;
  /// Is there road (or path) under the vehicle at `time`?
  [[nodiscard]] bool on_route(double time) const { return track_.reaches(track_.along(time)); }
  [[nodiscard]] bool has_arm() const { return spec_.body == "excavator"; }

 private:
  [[nodiscard]] Eigen::Isometry3d base(double time) const;
  [[nodiscard]] ArmAngles arm(double time) const;
  EgoSpec spec_;
  Track track_;
  Mesh hull_;
  Mesh boom_, stick_, bucket_;
};

}  // namespace raymoval::simulated
