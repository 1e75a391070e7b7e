// SPDX-License-Identifier: MIT
#include "methods/common/plane_fit.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace raymoval {
namespace {

using Solver = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;

/// Normal of points from the eigenvectors of their covariance.
Eigen::Vector3d normal_of(const Solver& solver) {
  const Eigen::Vector3d& spread = solver.eigenvalues();  // Ascending.
  // Single precision cannot distinguish smaller values from a line, or from a point (1 micrometre).
  constexpr double kLine = 1e-7, kPoint = 1e-12;
  if (spread[2] < kPoint) return Eigen::Vector3d::UnitZ();
  if (spread[1] < kLine * spread[2]) {
    const Eigen::Vector3d along = solver.eigenvectors().col(2);
    const Eigen::Vector3d normal = Eigen::Vector3d::UnitZ() - along.z() * along;
    return normal.norm() > 1e-3 ? normal.normalized() : Eigen::Vector3d::UnitX();
  }
  return solver.eigenvectors().col(0);
}

/// Turns a normal upward. If it is level within rounding, its largest component becomes positive.
Eigen::Vector3d turned_upward(const Eigen::Vector3d& normal) {
  int decisive = 2;
  if (std::abs(normal.z()) < 1e-9) normal.cwiseAbs().maxCoeff(&decisive);
  return normal[decisive] < 0.0 ? Eigen::Vector3d(-normal) : normal;
}

}  // namespace

PlaneFit fit_plane(std::span<const Eigen::Vector3d> points, std::span<const std::uint8_t> chosen) {
  const Eigen::Vector3d& origin = points.front();  // Near all points: squares stay small.
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  double count = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (chosen[i] == 0) continue;
    const Eigen::Vector3d from_origin = points[i] - origin;
    sum += from_origin;
    squares += from_origin * from_origin.transpose();
    count += 1.0;
  }
  const Eigen::Vector3d mean = sum / count;
  const Solver solver(squares / count - mean * mean.transpose());
  PlaneFit fit;
  fit.plane.normal = turned_upward(normal_of(solver));
  fit.plane.offset = -fit.plane.normal.dot(origin + mean);
  fit.centre = origin + mean;
  fit.variances = solver.eigenvalues();
  fit.points = count;
  return fit;
}

}  // namespace raymoval
