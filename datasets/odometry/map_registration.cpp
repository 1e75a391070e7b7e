// SPDX-License-Identifier: MIT
#include "datasets/odometry/map_registration.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/sampling.h"
#include "datasets/trajectories/trajectory.h"

namespace raymoval::odometry {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// Edge of the smallest cells: of the distance between points, of the median range; metres.
constexpr double kCellSpacings = 4.7, kMostOfRange = 0.08, kLeastCell = 0.2, kMostCell = 0.5;
constexpr double kNearestShare = 0.25;                       // of the median range
constexpr double kFarthest = 100.0;                          // metres
constexpr double kDenseSpacing = 0.4, kSparseSpacing = 1.5;  // cells
constexpr std::size_t kMostRegistered = 3000;
constexpr double kOnMap = 0.1;  // metres
/// Least share of the weights that determines a direction: a few trees along a road do.
constexpr double kLeastShare = 0.002;
constexpr int kMostSteps = 30;

/// Centroids of the points in cubic cells, in the order of the first point of each.
std::vector<Vector3f> centroids(const std::vector<Vector3f>& points, double cell_m) {
  struct Sum {
    Vector3f sum;
    float count;
  };
  std::vector<Sum> sums;
  VoxelMap<std::uint32_t> numbers;
  numbers.reserve(points.size() / 2);
  const double inverse = 1.0 / cell_m;
  for (const Vector3f& point : points) {
    const VoxelKey key = voxel_key(voxel_index(point.cast<double>(), inverse));
    const auto [found, is_new] = numbers.try_emplace(key, static_cast<std::uint32_t>(sums.size()));
    if (is_new) {
      sums.push_back({point, 1.0F});
    } else {
      sums[found->second].sum += point;
      sums[found->second].count += 1.0F;
    }
  }
  std::vector<Vector3f> means;
  means.reserve(sums.size());
  for (const Sum& sum : sums) means.push_back(sum.sum / sum.count);
  return means;
}

/// Transforms points to the time of the scan. A scan is cut into 256 parts of equal time.
class Deskewing {
 public:
  explicit Deskewing(const ScanMotion& motion) : times_(motion.point_times) {
    if (times_.empty() || !(motion.duration > 0.0)) return;
    const auto [least, most] = std::minmax_element(times_.begin(), times_.end());
    first_ = *least;
    width_ = std::max((*most - *least) / kParts, 1e-9);
    for (int k = 0; k <= kParts; ++k) {
      const double part = (first_ + (k + 0.5) * width_) / motion.duration;
      parts_.push_back(part_of(motion.motion, part).cast<float>());
    }
  }
  [[nodiscard]] Vector3f operator()(const Vector3f& point, std::size_t number) const {
    if (parts_.empty()) return point;
    return parts_[static_cast<std::size_t>((times_[number] - first_) / width_)] * point;
  }

 private:
  static constexpr int kParts = 256;
  const std::vector<double>& times_;
  double first_ = 0.0, width_ = 1.0;
  std::vector<Eigen::Isometry3f> parts_;
};

/// Whether planes determine the motion in all directions. Single points do not count: along the
/// edges of a corridor they seem to.
bool is_determined(const registration::Matches& matches) {
  registration::Matches planes;
  for (const registration::Match& match : matches) {
    if (match.weight > PlaneMap::kRoughWeight)
      planes.push_back({match.at, match.normal, match.distance});
  }
  return !planes.empty() && registration::plane_step(planes, kOnMap, kLeastShare).determined == 6;
}

}  // namespace

double usual_deviation(double period_s) {
  constexpr double kLeast = 0.17, kAcceleration = 3.0;  // metres; metres per square second
  return std::max(kLeast, 0.5 * kAcceleration * period_s * period_s);
}

ScanScale scale_of(const Scan& scan) {
  std::vector<float> ranges;
  for (const Vector3f& point : scan.points) ranges.push_back(point.norm());
  const double range = median_in_place(ranges);
  const double spacing =
      range * std::sqrt(4.0 * std::numbers::pi / static_cast<double>(scan.size()));
  const double cell = std::min(kCellSpacings * spacing, kMostOfRange * range);
  return {range, std::clamp(cell, kLeastCell, kMostCell)};
}

std::vector<Vector3f> few_of(const std::vector<Vector3f>& points, std::size_t most) {
  std::vector<Vector3f> few;
  for (const std::size_t i : evenly_spread(points.size(), most)) few.push_back(points[i]);
  return few;
}

ThinnedScan thinned(const Scan& scan, const ScanMotion& motion, const ScanScale& scale) {
  const Deskewing deskewing(motion);
  const auto nearest = static_cast<float>(kNearestShare * scale.range);
  std::vector<Vector3f> points;
  points.reserve(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const float range = scan.points[i].norm();
    if (range < nearest || range > static_cast<float>(kFarthest)) continue;
    points.push_back(deskewing(scan.points[i], i));
  }
  ThinnedScan thin;
  thin.dense = centroids(points, kDenseSpacing * scale.cell);
  thin.sparse = few_of(centroids(thin.dense, kSparseSpacing * scale.cell), kMostRegistered);
  return thin;
}

Registered register_to_map(const PlaneMap& map, const std::vector<Vector3f>& points,
                           const Pose& guess, double reach) {
  Registered result{.T_map_sensor = guess};
  for (int k = 0; k < kMostSteps; ++k) {
    const double now = std::max(kLeastReach, reach * std::pow(0.75, k));
    const registration::Matches matches = map.match(points, result.T_map_sensor, now);
    const double cut = std::max(3.0 * registration::robust_deviation(matches), 0.5 * now);
    const registration::PlaneStep step = registration::plane_step(matches, cut, kLeastShare);
    const Pose before = result.T_map_sensor;
    result.T_map_sensor = step.motion * before;
    const double moved = (result.T_map_sensor.translation() - before.translation()).norm() +
                         10.0 * (step.motion.linear() - Eigen::Matrix3d::Identity()).norm();
    if (step.determined == 0 || (now <= kLeastReach && moved < 0.002)) break;
  }
  const registration::Matches matches = map.match(points, result.T_map_sensor, 2.0 * map.cell());
  result.determined = is_determined(matches);
  double on_map = 0.0;
  for (const registration::Match& match : matches) {
    on_map += std::max(0.0, 1.0 - std::abs(match.distance) / kOnMap);
  }
  if (matches.empty()) return result;
  result.overlap = on_map / static_cast<double>(matches.size());
  result.matched =
      std::min(1.0, static_cast<double>(matches.size()) / static_cast<double>(points.size()));
  return result;
}

}  // namespace raymoval::odometry
