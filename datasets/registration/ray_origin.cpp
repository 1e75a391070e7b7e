// SPDX-License-Identifier: MIT
#include "datasets/registration/ray_origin.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

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

/// How far a line leaves the cone around `origin`, from 0 to 1.
double misfit(const Line& line, const Vector3d& origin, double fits) {
  const Vector3d ray = (line.at - origin).normalized();
  if (std::abs(ray.z()) < kLevel) return 0.5;
  const Vector3d rising = (Vector3d::UnitZ() - ray.z() * ray).normalized();
  // The part across the ray: the part along it is range noise and the slope of the surface.
  const Vector3d seen = (line.direction - line.direction.dot(ray) * ray).normalized();
  const double angle = std::asin(std::min(1.0, std::abs(seen.dot(rising))));
  return std::min(1.0, angle / (fits * kDegree));
}

std::vector<double> misfits(const std::vector<Line>& lines, const Vector3d& origin,
                            double fits = kFits) {
  std::vector<double> all;
  all.reserve(lines.size());
  for (const Line& line : lines) all.push_back(misfit(line, origin, fits));
  return all;
}

/// A lower bound of the misfit that takes less time. It replaces the angle by its sine.
double least_misfit(const Line& line, const Vector3d& origin, double fits) {
  constexpr double kLess = 1.0 - 1e-6, kTiny = 1e-6;  // far above the errors of rounding
  const Vector3d to = line.at - origin;
  const double square = to.squaredNorm(), along = line.direction.dot(to);
  const double of_line = line.direction.squaredNorm() * square, up = to.z() * to.z();
  if (up < kLess * kLevel * kLevel * square) return 0.5;
  const double seen = of_line - along * along, rising = square - up;
  if (up * kLess < kLevel * kLevel * square || seen < kTiny * of_line || rising < kTiny * square) {
    return 0.0;
  }
  const double rise = std::abs(line.direction.z() * square - to.z() * along);
  return std::min(1.0, kLess * rise / (std::sqrt(seen * rising) * fits * kDegree));
}

/// Sum of the misfits, each at most `other`; where it passes `most`, what it is there.
template <class Misfit>
double sum_of(Misfit&& misfit_of, const std::vector<Line>& lines, const std::vector<double>& other,
              double most) {
  double sum = 0.0;
  for (std::size_t i = 0; i < lines.size() && sum <= most; ++i) {
    sum += std::min(other[i], misfit_of(lines[i]));
  }
  return sum;
}

/// Mean of the misfits, each at most `other`. If the mean is not less than `most`, the answer may
/// be any value that is not less.
double mean_misfit(const std::vector<Line>& lines, const Vector3d& origin, double fits,
                   const std::vector<double>& other, double most = 1.0) {
  const auto count = static_cast<double>(lines.size());
  const double most_sum = (1.0 + 1e-6) * most * count;
  const auto least = [&](const Line& line) { return least_misfit(line, origin, fits); };
  const auto exact = [&](const Line& line) { return misfit(line, origin, fits); };
  double sum = sum_of(least, lines, other, most_sum);
  if (sum <= most_sum) sum = sum_of(exact, lines, other, most_sum);
  return sum / count;
}

/// The best of a grid around `origin`, which it replaces; lines that fit `other` better count so.
/// @param other misfits to another origin; all 1 if there is none
/// @return its misfit
double search_grid(const std::vector<Line>& lines, double span, int steps, double fits,
                   const std::vector<double>& other, Vector3d& origin) {
  const Vector3d centre = origin;
  double best = mean_misfit(lines, centre, fits, other);
  for (int x = -steps; x <= steps; ++x) {
    for (int y = -steps; y <= steps; ++y) {
      for (int z = -steps; z <= steps; ++z) {
        const Vector3d at = centre + span / steps * Vector3d(x, y, z);
        const double reached = mean_misfit(lines, at, fits, other, best);
        if (reached >= best) continue;
        best = reached;
        origin = at;
      }
    }
  }
  return best;
}

std::vector<Line> lines_of(const std::vector<Scan>& scans) {
  std::vector<Line> lines;
  for (const Scan& scan : scans) add_lines(scan, lines);
  return lines;
}

RayOrigin best_origin(const std::vector<Line>& lines) {
  RayOrigin found;
  found.lines = lines.size();
  if (lines.empty()) return found;
  const std::vector<double> none(lines.size(), 1.0);
  found.misfit_given = mean_misfit(lines, Vector3d::Zero(), kFits, none);
  // A loose limit at first: half a metre beside the origin, hardly any line fits closely.
  search_grid(lines, kFarthestOrigin, 6, 8.0 * kFits, none, found.origin);
  search_grid(lines, 0.5, 3, 4.0 * kFits, none, found.origin);
  for (const double span : {0.3, 0.2, 0.1, 0.05, 0.02}) {
    found.misfit_found = search_grid(lines, span, 2, kFits, none, found.origin);
  }
  return found;
}

/// Two origins, and how well the lines fit the better of both.
struct TwoOrigins {
  Vector3d first, second;
  double gain = 0.0;   ///< Of misfit, beside that of the best single origin.
  double share = 0.0;  ///< Of the second origin, among the lines that clearly fit one origin.
};

TwoOrigins two_origins(const std::vector<Scan>& scans) {
  constexpr double kClearly = 0.2;
  const std::vector<Line> lines = lines_of(scans);
  const RayOrigin single = best_origin(lines);
  TwoOrigins two{single.origin, Vector3d::Zero()};
  if (lines.empty()) return two;
  // Loose at first, as for one origin.
  search_grid(lines, kFarthestOrigin, 6, 8.0 * kFits, misfits(lines, two.first, 8.0 * kFits),
              two.second);
  search_grid(lines, 0.5, 3, 4.0 * kFits, misfits(lines, two.first, 4.0 * kFits), two.second);
  search_grid(lines, 0.5, 3, 4.0 * kFits, misfits(lines, two.second, 4.0 * kFits), two.first);
  double reached = 1.0;
  for (int round = 0; round < 2; ++round) {
    for (const double span : {0.5, 0.2, 0.05}) {
      search_grid(lines, span, 2, kFits, misfits(lines, two.second), two.first);
      reached = search_grid(lines, span, 2, kFits, misfits(lines, two.first), two.second);
    }
  }
  two.gain = single.misfit_found - reached;
  const auto to_first = misfits(lines, two.first), to_second = misfits(lines, two.second);
  std::size_t first = 0, second = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (to_first[i] < to_second[i] - kClearly) ++first;
    if (to_second[i] < to_first[i] - kClearly) ++second;
  }
  two.share =
      static_cast<double>(second) / static_cast<double>(std::max<std::size_t>(first + second, 1));
  return two;
}

}  // namespace

RayOrigin find_ray_origin(const std::vector<Scan>& scans) {
  return best_origin(lines_of(scans));
}

std::optional<std::array<Vector3d, 2>> find_merged_origins(const std::vector<Scan>& scans) {
  constexpr double kGain = 0.1, kLeastShare = 0.35, kApart = 0.8, kSame = 0.4;  // two in metres
  std::array<TwoOrigins, 2> found;
  for (std::size_t half = 0; half < 2; ++half) {
    std::vector<Scan> some;
    for (std::size_t i = half; i < scans.size(); i += 2) some.push_back(scans[i]);
    TwoOrigins& two = found[half] = two_origins(some);
    if (two.gain < kGain || std::abs(two.share - 0.5) > 0.5 - kLeastShare ||
        (two.first - two.second).norm() < kApart) {
      return std::nullopt;
    }
    const TwoOrigins& before = found[0];
    if ((two.first - before.first).norm() > (two.first - before.second).norm()) {
      std::swap(two.first, two.second);
    }
    if ((two.first - before.first).norm() > kSame || (two.second - before.second).norm() > kSame) {
      return std::nullopt;
    }
  }
  return std::array<Vector3d, 2>{found[0].first, found[0].second};
}

}  // namespace raymoval::registration
