// SPDX-License-Identifier: MIT
#include "datasets/simulation/sensor/pose_noise.h"

#include <cmath>

#include "core/angle.h"
#include "datasets/simulation/shapes/random.h"

namespace raymoval::simulated {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

Vector6 six_normals(std::uint64_t seed, Purpose purpose, std::size_t scan) {
  Random random(seed, purpose, scan);
  Vector6 values;
  for (int i = 0; i < 6; ++i) values[i] = random.normal();
  return values;
}

}  // namespace

std::vector<Pose> pose_errors(const PoseNoise& noise, double severity, std::size_t count,
                              double period_s, std::uint64_t seed) {
  std::vector<Pose> errors(count, Pose::Identity());
  if (severity == 0.0) return errors;
  Vector6 drift_size;
  drift_size << noise.drift_m, noise.drift_m, 0.5 * noise.drift_m,
      Eigen::Vector3d::Constant(noise.drift_deg * kDegree);
  Vector6 jitter_size;
  jitter_size << Eigen::Vector3d::Constant(noise.jitter_m),
      Eigen::Vector3d::Constant(noise.jitter_deg * kDegree);
  // An Ornstein-Uhlenbeck process in steps of one scan.
  const double keep = std::exp(-period_s / noise.drift_time_s);
  const double fresh = std::sqrt(1.0 - keep * keep);
  Vector6 drift = Vector6::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) drift = keep * drift + fresh * six_normals(seed, Purpose::kDrift, i);
    const Vector6 error =
        severity * (drift.cwiseProduct(drift_size) +
                    six_normals(seed, Purpose::kJitter, i).cwiseProduct(jitter_size));
    const Eigen::Vector3d turn = error.tail<3>();
    const double angle = turn.norm();
    errors[i].translation() = error.head<3>();
    if (angle > 0.0) {
      errors[i].linear() = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
    }
  }
  return errors;
}

}  // namespace raymoval::simulated
