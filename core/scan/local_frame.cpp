// SPDX-License-Identifier: MIT
#include "core/scan/local_frame.h"

#include <cmath>
#include <numbers>

#include "core/text.h"

namespace raymoval {

LocalFrameSource::LocalFrameSource(const ScanSource& source, const Pose& T_local_world,
                                   const Eigen::Vector3d& spin_axis)
    : source_(source), T_local_world_(T_local_world), turn_(turn_to_z(spin_axis)) {
  if (turn_ == Eigen::Matrix3d::Identity()) return;
  turned_sensor_ = source.sensor();
  turned_sensor_->spin_axis = Eigen::Vector3d::UnitZ();
}

Scan LocalFrameSource::load(std::size_t index) const {
  Scan scan = source_.load(index);
  if (turned_sensor_) turn_sensor_frame(turn_, scan);
  scan.T_world_sensor = T_local_world_ * scan.T_world_sensor;
  return scan;
}

Pose LocalFrameSource::pose(std::size_t index) const {
  const Pose T_world_sensor = source_.pose(index);
  return T_local_world_ *
         (turned_sensor_ ? T_world_sensor * Pose(turn_.transpose()) : T_world_sensor);
}

const SensorModel& LocalFrameSource::sensor() const {
  return turned_sensor_ ? *turned_sensor_ : source_.sensor();
}

void turn_sensor_frame(const Eigen::Matrix3d& turn, Scan& scan) {
  for (Eigen::Vector3f& point : scan.points) {
    point = (turn * point.cast<double>()).cast<float>();
  }
  scan.T_world_sensor = scan.T_world_sensor * Pose(turn.transpose());
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

std::string axis_text(const Eigen::Vector3d& axis) {
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (std::abs(axis[i]) < 1.0 - 1e-12) continue;
    return std::string(axis[i] < 0.0 ? "-" : "") + static_cast<char>('x' + i);
  }
  return fixed_text(axis.x(), 3) + "," + fixed_text(axis.y(), 3) + "," + fixed_text(axis.z(), 3);
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
