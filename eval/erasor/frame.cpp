// SPDX-License-Identifier: MIT
#include "eval/erasor/frame.h"

namespace raymoval::erasor {
namespace {

Pose make_fixed_calibration() {
  Pose pose = Pose::Identity();
  pose.linear() << -1.857739385241e-03, -9.999659513510e-01, -8.039975204516e-03,  //
      -6.481465826011e-03, 8.051860151134e-03, -9.999466081774e-01,                //
      9.999773098287e-01, -1.805528627661e-03, -6.496203536139e-03;
  pose.translation() << -4.784029760483e-03, -7.337429464231e-02, -3.339968064433e-01;
  return pose;
}

/// Camera axes (right, down, forward) to forward, left, up.
Pose make_axes() {
  Pose pose = Pose::Identity();
  pose.linear() << 0.0, 0.0, 1.0,  //
      -1.0, 0.0, 0.0,              //
      0.0, -1.0, 0.0;
  return pose;
}

}  // namespace

const Pose& fixed_calibration() {
  static const Pose pose = make_fixed_calibration();
  return pose;
}

Pose erasor_pose(const Pose& T_world_sensor, const Pose& T_camera_lidar) {
  static const Pose axes = make_axes();
  const Pose camera_pose = T_camera_lidar * T_world_sensor * T_camera_lidar.inverse();
  return axes * camera_pose * fixed_calibration();
}

}  // namespace raymoval::erasor
