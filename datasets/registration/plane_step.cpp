// SPDX-License-Identifier: MIT
#include "datasets/registration/plane_step.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

#include "core/sampling.h"

namespace raymoval::registration {
namespace {

using Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr double kLeastWeight = 25.0;  // Sum of the weights below which nothing is determined.

}  // namespace

double robust_deviation(const Matches& matches) {
  if (matches.empty()) return 0.0;
  std::vector<double> sizes;
  sizes.reserve(matches.size());
  for (const Match& match : matches) sizes.push_back(std::abs(match.distance));
  return 1.4826 * median_in_place(sizes);
}

PlaneStep plane_step(const Matches& matches, double cut, double least_share) {
  Vector3d centre = Vector3d::Zero();
  for (const Match& match : matches) centre += match.at;
  centre /= static_cast<double>(matches.size());
  double square = 0.0;
  for (const Match& match : matches) square += (match.at - centre).squaredNorm();
  const double lever = std::sqrt(square / static_cast<double>(matches.size()));

  Matrix6d hessian = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  double total = 0.0;
  for (const Match& match : matches) {
    const double u = match.distance / cut;
    if (std::abs(u) >= 1.0) continue;
    const double weight = match.weight * (1.0 - u * u) * (1.0 - u * u);
    Vector6d jacobian;
    jacobian << (match.at - centre).cross(match.normal) / lever, match.normal;
    hessian += weight * jacobian * jacobian.transpose();
    gradient += weight * match.distance * jacobian;
    total += weight;
  }
  PlaneStep step;
  if (total < kLeastWeight) return step;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(hessian / total);
  Vector6d delta = Vector6d::Zero();
  for (int k = 0; k < 6; ++k) {
    if (solver.eigenvalues()[k] < least_share) continue;
    ++step.determined;
    const Vector6d direction = solver.eigenvectors().col(k);
    delta -= direction.dot(gradient) / total / solver.eigenvalues()[k] * direction;
  }
  const Vector3d turn = delta.head<3>() / lever;
  if (turn.norm() > 1e-12) {
    step.motion.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  }
  step.motion.translation() = centre + delta.tail<3>() - step.motion.linear() * centre;
  return step;
}

}  // namespace raymoval::registration
