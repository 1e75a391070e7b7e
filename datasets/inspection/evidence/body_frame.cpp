// SPDX-License-Identifier: MIT
#include "datasets/inspection/evidence/body_frame.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "core/text.h"

namespace raymoval::inspection {
namespace {

Eigen::Vector3d turn_vector(const Pose& motion) {
  const Eigen::AngleAxisd turn(motion.linear());
  return turn.angle() * turn.axis();
}

Pose given_motion(const Samples& samples, const ScanPair& pair) {
  return samples.poses()[pair.from].inverse() * samples.poses()[pair.to];
}

/// Without a sign before a zero.
std::string rounded_text(double value, double step) {
  const double rounded = std::round(value / step) * step;
  return number_text(std::round((rounded == 0.0 ? 0.0 : rounded) * 1e5) / 1e5);
}

}  // namespace

bool turns_as_much(const Samples& samples, const std::vector<SeenMotion>& seen) {
  constexpr double kSame = 0.02;  // radians
  std::size_t same = 0;
  for (const SeenMotion& one : seen) {
    const double given = turn_vector(given_motion(samples, one.pair)).norm();
    if (std::abs(given - turn_vector(one.motion).norm()) < kSame) ++same;
  }
  return !seen.empty() && 4 * same >= 3 * seen.size();
}

std::vector<Eigen::Matrix3d> turns_on_body(const Samples& samples,
                                           const std::vector<SeenMotion>& seen) {
  constexpr double kLeast = 1.0;  // metres of way, all pairs together
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  double way = 0.0;
  for (const SeenMotion& one : seen) {
    const Pose given = given_motion(samples, one.pair);
    moments += given.translation() * one.motion.translation().transpose();
    moments += kTurnLever * kTurnLever * turn_vector(given) * turn_vector(one.motion).transpose();
    way += one.motion.translation().norm();
  }
  if (way < kLeast) return {};
  const double yaw = std::atan2(moments(1, 0) - moments(0, 1), moments(0, 0) + moments(1, 1));
  const Eigen::Matrix3d upright =
      Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(moments, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d proper = Eigen::Matrix3d::Identity();
  proper(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() > 0.0 ? 1.0 : -1.0;
  return {upright, svd.matrixU() * proper * svd.matrixV().transpose()};
}

std::string turn_text(const Eigen::Matrix3d& turn) {
  constexpr double kUpright = 0.9962;  // Within 5 degrees.
  const double yaw = std::atan2(turn(1, 0), turn(0, 0));
  if (turn(2, 2) > kUpright) return rounded_text(yaw / kDegree, 1.0) + " degrees about z";
  const double roll = std::atan2(turn(2, 1), turn(2, 2));
  const double pitch = std::asin(std::clamp(-turn(2, 0), -1.0, 1.0));
  return "roll " + rounded_text(roll / kDegree, 1.0) + ", pitch " +
         rounded_text(pitch / kDegree, 1.0) + ", yaw " + rounded_text(yaw / kDegree, 1.0) +
         " degrees";
}

std::string mounting_text(const Eigen::Matrix3d& turn) {
  Eigen::Quaterniond q(turn);
  if (q.w() < 0.0) q.coeffs() *= -1.0;
  std::string text = "0,0,0";
  for (const double value : {q.x(), q.y(), q.z(), q.w()}) text += ',' + rounded_text(value, 1e-5);
  return text;
}

}  // namespace raymoval::inspection
