// SPDX-License-Identifier: MIT
#include "datasets/registration/ray_origin.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/angle.h"
#include "core/point_tree.h"
#include "core/sampling.h"

namespace raymoval::registration {
namespace {

using Eigen::Vector3d;

constexpr float kNearestLine = 2.0F, kFarthestLine = 30.0F;            // metres
constexpr std::size_t kMostLines = 2000;                               // per scan
constexpr float kNearestNeighbour = 0.01F, kFarthestNeighbour = 1.5F;  // metres
constexpr double kStraight = 0.98;  // cosine of the bend of a scan line between three points
constexpr double kFits = 2.0;       // degrees from the cone at which a line does not fit
/// Sine of the elevation below which a line is ignored: for an origin on the ground, all lines on
/// the ground are level and keep their elevation.
constexpr double kLevel = 0.05;
constexpr double kFarthestOrigin = 3;  // metres

struct Line {
  Vector3d at, direction;
};

/// The scan line through `point`: its two nearest neighbours, if they lie on opposite sides.
bool fit_line(const PointTree<Eigen::Vector3f>& tree, const std::vector<Eigen::Vector3f>& points,
              const Eigen::Vector3f& point, Line& line) {
  std::vector<std::uint32_t> numbers(3);
  std::vector<float> squares(3);
  if (tree.find_nearest(point.data(), numbers, squares) < 3) return false;
  if (squares[1] < kNearestNeighbour * kNearestNeighbour ||
      squares[2] > kFarthestNeighbour * kFarthestNeighbour)
    return false;
  const Vector3d a = (points[numbers[1]] - point).cast<double>();
  const Vector3d b = (points[numbers[2]] - point).cast<double>();
  if (a.dot(b) > -kStraight * a.norm() * b.norm()) return false;
  line = {point.cast<double>(), a - b};
  return true;
}

void add_lines(const Scan& scan, std::vector<Line>& lines) {
  std::vector<std::size_t> in_reach;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const float range = scan.points[i].norm();
    if (range >= kNearestLine && range <= kFarthestLine) in_reach.push_back(i);
  }
  const PointTree<Eigen::Vector3f> tree(scan.points);
  Line line;
  for (const std::size_t k : evenly_spread(in_reach.size(), kMostLines)) {
    if (fit_line(tree, scan.points, scan.points[in_reach[k]], line)) lines.push_back(line);
  }
}

/// Mean misfit of the lines to the cones around `origin`, 0 to 1.
double misfit(const std::vector<Line>& lines, const Vector3d& origin, double fits = kFits) {
  double sum = 0.0;
  for (const Line& line : lines) {
    const Vector3d ray = (line.at - origin).normalized();
    if (std::abs(ray.z()) < kLevel) {
      sum += 0.5;
      continue;
    }
    const Vector3d rising = (Vector3d::UnitZ() - ray.z() * ray).normalized();
    // The part across the ray: the part along it is range noise and the slope of the surface.
    const Vector3d seen = (line.direction - line.direction.dot(ray) * ray).normalized();
    const double angle = std::asin(std::min(1.0, std::abs(seen.dot(rising))));
    sum += std::min(1.0, angle / (fits * kDegree));
  }
  return sum / static_cast<double>(lines.size());
}

/// The best of a grid around `origin`.
void search_grid(const std::vector<Line>& lines, double span, int steps, double fits,
                 RayOrigin& best) {
  const Vector3d centre = best.origin;
  best.misfit_found = misfit(lines, centre, fits);
  for (int x = -steps; x <= steps; ++x) {
    for (int y = -steps; y <= steps; ++y) {
      for (int z = -steps; z <= steps; ++z) {
        const Vector3d origin = centre + span / steps * Vector3d(x, y, z);
        const double reached = misfit(lines, origin, fits);
        if (reached < best.misfit_found) {
          best.misfit_found = reached;
          best.origin = origin;
        }
      }
    }
  }
}

}  // namespace

RayOrigin find_ray_origin(const std::vector<Scan>& scans) {
  std::vector<Line> lines;
  for (const Scan& scan : scans) add_lines(scan, lines);
  RayOrigin found;
  found.lines = lines.size();
  if (lines.empty()) return found;
  found.misfit_given = misfit(lines, Vector3d::Zero());
  // A loose limit at first: half a metre beside the origin, hardly any line fits closely.
  search_grid(lines, kFarthestOrigin, 6, 8.0 * kFits, found);
  search_grid(lines, 0.5, 3, 4.0 * kFits, found);
  for (const double span : {0.3, 0.2, 0.1, 0.05, 0.02}) search_grid(lines, span, 2, kFits, found);
  return found;
}

}  // namespace raymoval::registration
