// SPDX-License-Identifier: MIT
// "Patchwork++"; the steps are numbered in ground_segmentation.h.
#include "methods/common/patchwork/ground_segmentation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/angle.h"
#include "core/parallel.h"
#include "core/sampling.h"
#include "core/scan/local_frame.h"

namespace raymoval::patchwork {
namespace {

// Constants of Patchwork++.
/// A mirrored point is more than this depth (metres) below the ground, and steeper than this
/// elevation.
constexpr double kMirroredDepth = 0.8, kMirroredElevation = -15.0 * kDegree;
/// A plane that is neither low nor flat is compared with the mean flatness of its ring plus this
/// many deviations.
constexpr double kRingDeviations = 1.5;
/// A plane with more points is ground if its flatness is within the ground distance.
constexpr double kManyPoints = 1500.0;
/// A plane with a larger ratio of its two variances is a line, and not ground.
constexpr double kLineRatio = 8.0;
// Work for a thread at a time; no effect on the result.
constexpr std::size_t kPointsATask = 8192, kBinsATask = 8;

double first_height(const GroundParameters& parameters) {
  return parameters.public_height ? parameters.sensor_height
                                  : std::numeric_limits<double>::infinity();
}

// Stored planes of a ring, and deviations above their mean.
constexpr std::size_t kMostStored = 1000;
constexpr double kElevationDeviations = 2.0, kInnermostElevationDeviations = 3.0;
constexpr double kFlatnessDeviations = 1.0;

void push(std::deque<double>& values, double value) {
  values.push_back(value);
  if (values.size() > kMostStored) values.pop_front();
}

/// In the innermost zone, points deeper than this multiple of the sensor's height are mirrored and
/// do not seed the ground ('adaptive_seed_selection_margin' of Patchwork++).
constexpr double kDeepestGround = 1.2;

/// One bin while its planes are fitted.
class BinFit {
 public:
  BinFit(std::span<const Eigen::Vector3d> points, const BinSurroundings& surroundings,
         const GroundParameters& parameters, std::span<std::uint8_t> ground)
      : points_(points),
        parameters_(parameters),
        ground_(ground),
        left_(points.size(), 1),
        deepest_(surroundings.is_innermost ? -kDeepestGround * surroundings.sensor_height
                                           : -std::numeric_limits<double>::infinity()) {}

  /// R-VPF. @return whether points remain
  bool take_walls_out() {
    for (int round = 0; round < parameters_.plane_rounds; ++round) {
      choose_seeds(parameters_.wall_seed_height);
      const Plane plane = fit_plane(points_, ground_).plane;
      if (plane.normal.z() >= parameters_.upright) return true;
      for (std::size_t i = 0; i < points_.size(); ++i) {
        if (std::abs(plane.height_of(points_[i])) < parameters_.wall_distance) left_[i] = 0;
      }
      if (std::find(left_.begin(), left_.end(), 1) == left_.end()) return false;
    }
    return true;
  }

  /// R-GPF.
  PlaneFit fit_ground() {
    choose_seeds(parameters_.seed_height);
    PlaneFit fit = fit_plane(points_, ground_);
    for (int round = 0; round < parameters_.plane_rounds; ++round) {
      for (std::size_t i = 0; i < points_.size(); ++i) {
        const bool is_near = fit.plane.height_of(points_[i]) < parameters_.ground_distance;
        ground_[i] = left_[i] != 0 && is_near ? 1 : 0;
      }
      // Some points of the fit are not above the plane, so that at least one is chosen.
      fit = fit_plane(points_, ground_);
    }
    return fit;
  }

 private:
  /// Mean height of the lowest remaining points.
  double lowest_height() {
    heights_.clear();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (left_[i] != 0 && points_[i].z() >= deepest_) heights_.push_back(points_[i].z());
    }
    // All are deep: the ground descends. All of them are seeds.
    if (heights_.empty()) return std::numeric_limits<double>::infinity();
    const std::size_t count =
        std::min(heights_.size(), static_cast<std::size_t>(parameters_.lowest_points));
    const auto end = heights_.begin() + static_cast<std::ptrdiff_t>(count);
    std::nth_element(heights_.begin(), end - 1, heights_.end());
    std::sort(heights_.begin(), end);  // So that the sum does not depend on the order of points.
    double sum = 0.0;
    for (auto height = heights_.begin(); height != end; ++height) sum += *height;
    return sum / static_cast<double>(count);
  }
  void choose_seeds(double above) {
    const double limit = lowest_height() + above;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      ground_[i] = left_[i] != 0 && points_[i].z() < limit ? 1 : 0;
    }
  }

  std::span<const Eigen::Vector3d> points_;
  const GroundParameters& parameters_;
  std::span<std::uint8_t> ground_;
  Mask left_;  ///< 1 = in no wall.
  double deepest_;
  std::vector<double> heights_;  ///< Scratch.
};

}  // namespace

ZoneModel::ZoneModel(double from, double to)
    : bounds_{from, (7.0 * from + to) / 8.0, (3.0 * from + to) / 4.0, (from + to) / 2.0, to} {}

int ZoneModel::bin_of(double x, double y) const {
  const double distance = std::sqrt(x * x + y * y);
  if (!(distance >= bounds_.front() && distance <= bounds_.back())) return kNone;
  std::size_t zone = 0;
  int first = 0;
  while (zone + 1 < kRings.size() && distance >= bounds_[zone + 1]) {
    first += kRings[zone] * kSectors[zone];
    ++zone;
  }
  const double width = (bounds_[zone + 1] - bounds_[zone]) / kRings[zone];
  const int ring = static_cast<int>((distance - bounds_[zone]) / width);
  const double angle = std::atan2(y, x);
  const int sector =
      static_cast<int>((angle < 0.0 ? angle + kTurn : angle) / kTurn * kSectors[zone]);
  return first + std::min(ring, kRings[zone] - 1) * kSectors[zone] +
         std::min(sector, kSectors[zone] - 1);
}

int ZoneModel::first_bin(int ring) {
  int first = 0;
  for (std::size_t zone = 0; zone < kRings.size(); ++zone) {
    const int inside = std::min(ring, kRings[zone]);
    first += inside * kSectors[zone];
    ring -= inside;
  }
  return first;
}

MeanAndDeviation mean_and_deviation(const std::deque<double>& values) {
  const auto count = static_cast<double>(values.size());
  MeanAndDeviation found;
  found.mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double squares = 0.0;
  for (const double value : values) squares += (value - found.mean) * (value - found.mean);
  if (values.size() > 1) found.deviation = std::sqrt(squares / (count - 1.0));
  return found;
}

void GroundThresholds::store(int ring, double elevation, double flatness) {
  push(rings_.at(index(ring)).elevations, elevation);
  push(rings_.at(index(ring)).flatnesses, flatness);
}

void GroundThresholds::adapt() {
  for (std::size_t i = 0; i < rings_.size(); ++i) {
    Ring& ring = rings_[i];
    if (ring.elevations.empty()) continue;
    const MeanAndDeviation elevation = mean_and_deviation(ring.elevations);
    const MeanAndDeviation flatness = mean_and_deviation(ring.flatnesses);
    const double deviations = i == 0 ? kInnermostElevationDeviations : kElevationDeviations;
    ring.elevation = elevation.mean + deviations * elevation.deviation;
    ring.flatness = flatness.mean + kFlatnessDeviations * flatness.deviation;
    if (i == 0) sensor_height_ = -elevation.mean;
  }
}

std::optional<PlaneFit> find_bin_ground(std::span<const Eigen::Vector3d> points,
                                        const BinSurroundings& surroundings,
                                        const GroundParameters& parameters,
                                        std::span<std::uint8_t> ground) {
  BinFit bin(points, surroundings, parameters, ground);
  if (surroundings.is_innermost && !bin.take_walls_out()) {
    std::fill(ground.begin(), ground.end(), std::uint8_t{0});
    return std::nullopt;
  }
  return bin.fit_ground();
}

GroundSegmentation::GroundSegmentation(const GroundParameters& parameters)
    : parameters_(parameters),
      zones_(parameters.ground_min_range, parameters.ground_max_range),
      thresholds_(first_height(parameters)),
      is_height_known_(parameters.public_height) {}

Mask GroundSegmentation::find_ground(const Scan& scan, int threads) {
  place_points(scan, threads);
  fit_bins(threads);
  if (!is_height_known_) {
    find_sensor_height();
    if (is_height_known_) {  // Mirrored points can be found now.
      place_points(scan, threads);
      fit_bins(threads);
    }
  }
  for (int ring = 0; ring < ZoneModel::kAllRings; ++ring) judge_ring(ring);
  thresholds_.adapt();
  Mask mask(scan.size(), 0);
  for (std::size_t i = 0; i < point_.size(); ++i) mask[point_[i]] = ground_[i];
  return mask;
}

bool GroundSegmentation::is_mirrored(const Eigen::Vector3d& point, const Scan& scan,
                                     std::size_t i) const {
  if (scan.reflectance.empty()) return false;
  if (!(point.z() < -thresholds_.sensor_height() - kMirroredDepth)) return false;
  if (!(static_cast<double>(scan.reflectance[i]) < parameters_.noise_reflectance)) return false;
  return std::atan2(point.z(), point.head<2>().norm()) < kMirroredElevation;
}

void GroundSegmentation::place_points(const Scan& scan, int threads) {
  const Eigen::Matrix3d turn = parameters_.public_axes
                                   ? Eigen::Matrix3d(scan.T_world_sensor.linear())
                                   : turn_to_z(scan.T_world_sensor.linear().row(2).transpose());
  level_.resize(scan.size());
  bin_.resize(scan.size());
  parallel_for(threads, scan.size(), kPointsATask, [&](std::size_t i) {
    const Eigen::Vector3d point = turn * scan.points[i].cast<double>();
    level_[i] = point;
    bin_[i] = is_mirrored(point, scan, i) ? ZoneModel::kNone : zones_.bin_of(point.x(), point.y());
  });
  begin_.assign(ZoneModel::kAllBins + 1, 0);
  for (const int bin : bin_) {
    if (bin != ZoneModel::kNone) ++begin_[static_cast<std::size_t>(bin) + 1];
  }
  for (std::size_t bin = 0; bin < ZoneModel::kAllBins; ++bin) begin_[bin + 1] += begin_[bin];
  point_.resize(begin_.back());
  in_bins_.resize(begin_.back());
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t i = 0; i < bin_.size(); ++i) {
    if (bin_[i] == ZoneModel::kNone) continue;
    const std::size_t at = next[static_cast<std::size_t>(bin_[i])]++;
    point_[at] = static_cast<std::uint32_t>(i);
    in_bins_[at] = level_[i];
  }
}

void GroundSegmentation::fit_bins(int threads) {
  planes_.assign(ZoneModel::kAllBins, {});
  ground_.assign(point_.size(), 0);
  parallel_for(threads, ZoneModel::kAllBins, kBinsATask, [&](std::size_t i) {
    const int bin = static_cast<int>(i);
    if (points_in(bin) < static_cast<std::size_t>(parameters_.bin_points)) return;
    const BinSurroundings surroundings{ZoneModel::is_innermost_zone(bin),
                                       thresholds_.sensor_height()};
    planes_[i].fit =
        find_bin_ground(std::span(in_bins_).subspan(begin(bin), points_in(bin)), surroundings,
                        parameters_, std::span(ground_).subspan(begin(bin), points_in(bin)));
  });
}

void GroundSegmentation::find_sensor_height() {
  std::vector<double> heights;
  for (int bin = 0; ZoneModel::is_innermost_zone(bin); ++bin) {
    const BinPlane& plane = planes_[static_cast<std::size_t>(bin)];
    if (!plane.fit || !(plane.fit->plane.normal.z() > parameters_.upright)) continue;
    if (plane.elevation() < 0.0) heights.push_back(-plane.elevation());
  }
  if (heights.empty()) return;
  thresholds_.set_sensor_height(median(std::move(heights)));
  is_height_known_ = true;
}

void GroundSegmentation::judge_ring(int ring) {
  std::deque<double> flatnesses;  // Of the ring's planes that are low enough.
  std::vector<int> candidates;
  for (int bin = ZoneModel::first_bin(ring); bin < ZoneModel::first_bin(ring + 1); ++bin) {
    const BinPlane& plane = planes_[static_cast<std::size_t>(bin)];
    if (!plane.fit) continue;
    if (!(plane.fit->plane.normal.z() > parameters_.upright)) {
      drop_ground(bin);
      continue;
    }
    if (ring >= kProvedRings) continue;
    const bool is_low = plane.elevation() < thresholds_.elevation(ring);
    if (is_low) {
      thresholds_.store(ring, plane.elevation(), plane.flatness());
      flatnesses.push_back(plane.flatness());
    }
    if (!plane.faces_sensor()) {
      drop_ground(bin);
    } else if (!is_low && !(plane.flatness() < thresholds_.flatness(ring))) {
      candidates.push_back(bin);
    }
  }
  for (const int bin : candidates) {
    if (!is_like_ring(planes_[static_cast<std::size_t>(bin)], flatnesses)) drop_ground(bin);
  }
}

bool GroundSegmentation::is_like_ring(const BinPlane& plane,
                                      const std::deque<double>& flatnesses) const {
  if (plane.length_squared() > kLineRatio * plane.width_squared()) return false;
  const double own = parameters_.ground_distance * parameters_.ground_distance;
  if (plane.fit->points > kManyPoints && plane.flatness() < own) return true;
  if (flatnesses.empty()) return false;
  // The likelihood is a logistic function of the flatness; it is above one half below its midpoint.
  const MeanAndDeviation ring = mean_and_deviation(flatnesses);
  return plane.flatness() < ring.mean + kRingDeviations * ring.deviation;
}

void GroundSegmentation::drop_ground(int bin) {
  std::fill_n(ground_.begin() + static_cast<std::ptrdiff_t>(begin(bin)), points_in(bin),
              std::uint8_t{0});
}

}  // namespace raymoval::patchwork
