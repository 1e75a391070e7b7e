// SPDX-License-Identifier: MIT
#include "methods/erasor/ground_fit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace raymoval::erasor_method {
namespace {

/// Mean height of the lowest points after the first few, which may be outliers.
double lowest_point_representative(const std::vector<Eigen::Vector3d>& points,
                                   const Parameters& parameters) {
  std::vector<double> heights(points.size());
  std::transform(points.begin(), points.end(), heights.begin(),
                 [](const Eigen::Vector3d& point) { return point.z(); });
  const std::size_t first = static_cast<std::size_t>(parameters.lowest_skipped);
  const std::size_t last =
      std::min(heights.size(), first + static_cast<std::size_t>(parameters.lowest_averaged));
  if (first >= last) {
    return parameters.sparse_ground == SparseGround::kZero
               ? 0.0
               : *std::min_element(heights.begin(), heights.end());
  }
  std::partial_sort(heights.begin(), heights.begin() + static_cast<std::ptrdiff_t>(last),
                    heights.end());
  double sum = 0.0;
  for (std::size_t i = first; i < last; ++i) sum += heights[i];
  return sum / static_cast<double>(last - first);
}

/// Normal of points with this covariance.
Eigen::Vector3d normal_of(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  const Eigen::Vector3d& spread = solver.eigenvalues();  // Ascending.
  // Less than single precision can tell from a line, or from a point (1 micrometre).
  constexpr double kLine = 1e-7, kPoint = 1e-12;
  if (spread[2] < kPoint) return Eigen::Vector3d::UnitZ();
  if (spread[1] < kLine * spread[2]) {
    const Eigen::Vector3d along = solver.eigenvectors().col(2);
    const Eigen::Vector3d normal = Eigen::Vector3d::UnitZ() - along.z() * along;
    return normal.norm() > 1e-3 ? normal.normalized() : Eigen::Vector3d::UnitX();
  }
  return solver.eigenvectors().col(0);
}

/// Turns a normal upward; one that is level within rounding, so that its largest part is positive.
Eigen::Vector3d turned_upward(const Eigen::Vector3d& normal) {
  int decisive = 2;
  if (std::abs(normal.z()) < 1e-9) normal.cwiseAbs().maxCoeff(&decisive);
  return normal[decisive] < 0.0 ? Eigen::Vector3d(-normal) : normal;
}

}  // namespace

Plane fit_plane(const std::vector<Eigen::Vector3d>& points, const Mask& chosen) {
  const Eigen::Vector3d& origin = points.front();  // Near all of them: small numbers to square.
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
  Plane plane;
  plane.normal = turned_upward(normal_of(squares / count - mean * mean.transpose()));
  plane.offset = -plane.normal.dot(origin + mean);
  return plane;
}

Mask find_ground(const std::vector<Eigen::Vector3d>& points, const Parameters& parameters) {
  const Mask all(points.size(), 1);
  if (points.empty()) return all;
  const double limit = lowest_point_representative(points, parameters) + parameters.seed_height;
  Mask ground(points.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) ground[i] = points[i].z() < limit ? 1 : 0;
  for (int iteration = 0; iteration < parameters.plane_iterations; ++iteration) {
    if (std::find(ground.begin(), ground.end(), 1) == ground.end()) return all;
    const Plane plane = fit_plane(points, ground);
    if (parameters.require_upright && !(plane.normal.z() > std::numbers::sqrt2 / 2.0)) return all;
    // Every point below the plane is ground too, however deep, and not only the seeds.
    for (std::size_t i = 0; i < points.size(); ++i) {
      ground[i] = plane.height_of(points[i]) < parameters.ground_distance ? 1 : 0;
    }
  }
  return ground;
}

}  // namespace raymoval::erasor_method
