// SPDX-License-Identifier: MIT
#include "core/scan/local_frame.h"

#include <cmath>
#include <numbers>

namespace raymoval {

Pose LocalFrameSource::in_local_frame(const Pose& T_world_sensor) const {
  return T_local_world_ * T_world_sensor;
}

Eigen::Matrix3d turn_to_z(const Eigen::Vector3d& up) {
  constexpr double kExact = 1e-12;
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  if ((up - z).norm() < kExact) return Eigen::Matrix3d::Identity();
  Eigen::Matrix3d turn;
  const double cosine = z.dot(up.normalized());
  if (cosine < -1.0 + kExact) {  // Downward: any horizontal axis.
    turn = Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()).toRotationMatrix();
  } else {
    // As Quaterniond::FromTwoVectors, whose case of opposite vectors takes seconds to compile.
    const double twice = std::sqrt((1.0 + cosine) * 2.0);
    const Eigen::Vector3d axis = up.normalized().cross(z);
    Eigen::Quaterniond rotation;
    rotation.vec() = axis * (1.0 / twice);
    rotation.w() = twice * 0.5;
    turn = rotation.toRotationMatrix();
  }
  // Rounding must not tilt a lattice against axes that were only exchanged.
  for (double& entry : turn.reshaped()) {
    if (std::abs(entry - std::round(entry)) < kExact) entry = std::round(entry);
  }
  return turn;
}

Pose method_frame(const ScanSource& scans, const Eigen::Vector3d& up) {
  Pose T_local_world = Pose::Identity();
  if (scans.size() == 0) return T_local_world;
  T_local_world.linear() = turn_to_z(up);
  T_local_world.translation() = -(T_local_world.linear() * scans.pose(0).translation());
  return T_local_world;
}

Eigen::Vector3d lattice_origin(const ScanSource& scans) {
  constexpr double kKilometre = 1000.0;
  if (scans.size() == 0) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d first = scans.pose(0).translation();
  if (first.cwiseAbs().maxCoeff() <= kFarFromOrigin) return Eigen::Vector3d::Zero();
  return (first / kKilometre).array().round() * kKilometre;
}

Pose lattice_frame(const ScanSource& scans) {
  Pose frame = Pose::Identity();
  frame.translation() = -lattice_origin(scans);
  return frame;
}

}  // namespace raymoval
