// SPDX-License-Identifier: MIT
#include "methods/erasor/ground_fit.h"

#include <algorithm>
#include <numbers>

#include "methods/common/plane_fit.h"

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

}  // namespace

Mask find_ground(const std::vector<Eigen::Vector3d>& points, const Parameters& parameters) {
  const Mask all(points.size(), 1);
  if (points.empty()) return all;
  const double limit = lowest_point_representative(points, parameters) + parameters.seed_height;
  Mask ground(points.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) ground[i] = points[i].z() < limit ? 1 : 0;
  for (int iteration = 0; iteration < parameters.plane_iterations; ++iteration) {
    if (std::find(ground.begin(), ground.end(), 1) == ground.end()) return all;
    const Plane plane = fit_plane(points, ground).plane;
    if (parameters.require_upright && !(plane.normal.z() > std::numbers::sqrt2 / 2.0)) return all;
    // Every point below the plane is ground too, however deep, and not only the seeds.
    for (std::size_t i = 0; i < points.size(); ++i) {
      ground[i] = plane.height_of(points[i]) < parameters.ground_distance ? 1 : 0;
    }
  }
  return ground;
}

}  // namespace raymoval::erasor_method
