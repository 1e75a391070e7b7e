// SPDX-License-Identifier: MIT
#include "methods/erasor/polar_bins.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "methods/common/plane_fit.h"

namespace raymoval::erasor_method {
namespace {

constexpr double kObjectHeight = 0.5;  ///< Metres; a literal in the public code.

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
    return *std::min_element(heights.begin(), heights.end());
  }
  std::partial_sort(heights.begin(), heights.begin() + static_cast<std::ptrdiff_t>(last),
                    heights.end());
  double sum = 0.0;
  for (std::size_t i = first; i < last; ++i) sum += heights[i];
  return sum / static_cast<double>(last - first);
}

}  // namespace

PolarBins::PolarBins(const Parameters& parameters)
    : range_(parameters.maximum_range),
      minimum_height_(parameters.minimum_height),
      maximum_height_(parameters.maximum_height),
      rings_per_metre_(parameters.rings / parameters.maximum_range),
      sectors_per_radian_(parameters.sectors / (2.0 * std::numbers::pi)),
      rings_(parameters.rings),
      sectors_(parameters.sectors) {}

int PolarBins::bin_of(const Eigen::Vector3d& body) const {
  if (!(body.z() > minimum_height_ && body.z() < maximum_height_)) return -1;
  const double square = body.x() * body.x() + body.y() * body.y();
  if (!(square <= range_ * range_)) return -1;
  const int ring = std::min(static_cast<int>(std::sqrt(square) * rings_per_metre_), rings_ - 1);
  double theta = std::atan2(body.y(), body.x());
  // Also for y = -0 and x < 0, where the angle is -pi and a test of y alone would let it pass.
  if (theta < 0.0) theta += 2.0 * std::numbers::pi;
  const int sector = std::min(static_cast<int>(theta * sectors_per_radian_), sectors_ - 1);
  return ring * sectors_ + sector;
}

BinFinding compare_extents(const BinExtent& map, const BinExtent& query,
                           const Parameters& parameters) {
  if (query.points < parameters.minimum_points) return BinFinding::kTooFewPoints;
  if (map.points == 0) return BinFinding::kQueryOnly;
  const double of_map = map.extent(), of_query = query.extent();
  const double ratio = std::min(of_map, of_query) / std::max(of_map, of_query);
  // The ratio of two zeros is NaN, for which the comparison is false.
  if (!(ratio < parameters.ratio_threshold)) return BinFinding::kEqual;
  return of_map >= of_query ? BinFinding::kMapHigher : BinFinding::kCurrentHigher;
}

BinAction action_for(BinFinding finding, const BinExtent& map, const Parameters& parameters) {
  BinAction action;
  if (finding == BinFinding::kMapHigher) {
    action.remove = parameters.version == 3 ? map.extent() > kObjectHeight
                                            : map.highest > parameters.minimum_top;
    action.reinsert = action.remove;
  } else if (parameters.version == 2) {
    action.reinsert = finding == BinFinding::kEqual || finding == BinFinding::kQueryOnly;
  }
  return action;
}

Mask find_ground(const std::vector<Eigen::Vector3d>& points, const Parameters& parameters) {
  const Mask all(points.size(), 1);
  if (points.empty()) return all;
  const double limit = lowest_point_representative(points, parameters) + parameters.seed_height;
  Mask ground(points.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) ground[i] = points[i].z() < limit ? 1 : 0;
  for (int iteration = 0; iteration < parameters.plane_iterations; ++iteration) {
    if (std::find(ground.begin(), ground.end(), 1) == ground.end()) return all;
    const Plane plane = fit_plane(points, ground).plane;
    // Every point below the plane is ground too, at any depth, not only the seeds.
    for (std::size_t i = 0; i < points.size(); ++i) {
      ground[i] = plane.height_of(points[i]) < parameters.ground_distance ? 1 : 0;
    }
  }
  return ground;
}

}  // namespace raymoval::erasor_method
