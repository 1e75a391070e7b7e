// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "datasets/simulation/world/mover.h"

namespace raymoval::simulated {

/// The vehicle or person that carries the sensor.
struct EgoSpec {
  Route route;
  std::string body = "car";  ///< car, excavator or none.
  double sensor_height_m = 1.73;
  double sensor_forward_m = 0.0;
  double sensor_left_m = 0.0;
  double sensor_pitch_rad = 0.0;  ///< Positive = looking down.
  double sensor_roll_rad = 0.0;   ///< Positive = leaning to the right.
  /// Roll, pitch and yaw of the sensor in the vehicle's frame, after the angles above; radians.
  Eigen::Vector3d mount = Eigen::Vector3d::Zero();
  /// A person's gait: the body bobs and rocks with the steps, and turns slowly.
  double sway_m = 0.0;
  double sway_rad = 0.0;
  double step_hz = 1.9;
  double vibration_m = 0.0;
  double vibration_rad = 0.0;
  double dig_period_s = 18.0;  ///< Of an excavator: one dig, swing, dump, swing back.
};

/// The vehicle or person that carries the sensor: its pose, its shaking, and its visible surfaces.
class Ego {
 public:
  Ego(const EgoSpec& spec, const Ground& ground);

  /// True `T_world_sensor`.
  [[nodiscard]] Eigen::Isometry3d sensor_pose(double time) const;
  /// The same without `EgoSpec::mount`.
  [[nodiscard]] Eigen::Isometry3d usual_sensor_pose(double time) const;
  /// Adds the vehicle's surfaces (label 1) and an excavator's moving arm (label 259).
  void place(double time, std::vector<PlacedPart>& parts) const;
  /// Whether there is road (or path) under the vehicle at `time`.
  [[nodiscard]] bool on_route(double time) const { return track_.reaches(track_.along(time)); }
  [[nodiscard]] bool has_arm() const { return spec_.body == "excavator"; }

 private:
  [[nodiscard]] Eigen::Isometry3d base(double time) const;
  EgoSpec spec_;
  Track track_;
  Mesh hull_;
  Mesh boom_, stick_, bucket_;
};

}  // namespace raymoval::simulated
