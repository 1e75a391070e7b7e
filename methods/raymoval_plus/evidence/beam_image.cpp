// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/beam_image.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "core/floor.h"

namespace raymoval::raymoval_plus_method {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr double kUnknownStep = 0.2 * kDegree;
constexpr double kMarginRows = 2.0;
constexpr double kLeastRow = 0.01 * kDegree, kFewestColumns = 90.0, kMostColumns = 7200.0;
constexpr int kMostBins = 4'000'000;
constexpr int kBlockShift = 3;
/// Squares of the distances from a voxel's mean, in standard deviations, up to which a beam crosses
/// it and up to which one that ends there hits it.
constexpr float kCrosses = 1.0F, kMeets = 3.0F;
/// The root of the larger one: beams at most so many deviations aside are looked at.
constexpr float kWindow = 1.7320508F;
/// A margin for the rounding of squares of distances.
constexpr float kSquareRounding = 1e-6F;

/// Rows of beams so far apart may leave a voxel between them, metres; it is asked for up to so many
/// times the range from which it was seen.
constexpr float kRowGap = 0.3F, kFarther = 1.5F;
/// Beams so far apart leave gaps on surfaces that are filled, metres.
constexpr float kLeastGap = 0.1F, kMostGap = 1.5F;
/// A surface goes on to a neighbouring return that is deeper by at most so much more than it lies
/// aside, and at most so deep, metres.
constexpr float kDeeper = 0.2F, kMostDeeper = 1.0F;

/// Angle of a direction, radians. Abramowitz and Stegun, 4.4.49; error below 1e-5.
inline float arc_tangent(float y, float x) {
  const float a = std::abs(x), b = std::abs(y), most = std::max(a, b);
  const float q = most > 0.0F ? std::min(a, b) / most : 0.0F, s = q * q;
  float angle =
      q * (0.9998660F + s * (-0.3302995F + s * (0.1801410F + s * (-0.0851330F + s * 0.0208351F))));
  angle = b > a ? 0.5F * kPi - angle : angle;
  angle = x < 0.0F ? kPi - angle : angle;
  return y < 0.0F ? -angle : angle;
}

}  // namespace

BeamImage::BeamImage(const SensorModel& sensor, const Parameters& parameters)
    : range_min_(static_cast<float>(parameters.evidence_range_min)),
      range_max_(static_cast<float>(parameters.evidence_range_max)),
      hit_(static_cast<float>(parameters.hit_distance)),
      pass_(static_cast<float>(parameters.pass_distance)),
      nearest_(static_cast<float>(parameters.minimum_range)) {
  const double width = sensor.azimuth_step > 0.0 ? sensor.azimuth_step : kUnknownStep;
  const double height =
      std::max(sensor.elevation_step > 0.0 ? 0.5 * sensor.elevation_step : kUnknownStep, kLeastRow);
  // A whole number of blocks, so that those at both ends meet.
  const double columns = std::clamp(2.0 * std::numbers::pi / width, kFewestColumns, kMostColumns);
  columns_ = static_cast<int>(std::round(columns / (1 << kBlockShift))) << kBlockShift;
  azimuth_step_ = 2.0F * kPi / static_cast<float>(columns_);
  const double low = std::max(sensor.elevation_min - kMarginRows * height, -std::numbers::pi / 2.0);
  const double high = std::min(sensor.elevation_max + kMarginRows * height, std::numbers::pi / 2.0);
  rows_ = static_cast<int>(
      std::clamp(std::ceil((high - low) / height), 1.0, static_cast<double>(kMostBins / columns_)));
  elevation_step_ = static_cast<float>((high - low) / rows_);
  lowest_ = static_cast<float>(low);
  block_columns_ = (columns_ >> kBlockShift) + 1;
}

float BeamImage::azimuth_bin(const Eigen::Vector3f& p) const {
  return (arc_tangent(p.y(), p.x()) + kPi) / azimuth_step_;
}

float BeamImage::elevation_bin(const Eigen::Vector3f& p, float flat) const {
  return (arc_tangent(p.z(), flat) - lowest_) / elevation_step_;
}

void BeamImage::fill(const Scan& scan) {
  const Eigen::Matrix3f R_world_sensor = scan.T_world_sensor.linear().cast<float>();
  R_sensor_world_ = R_world_sensor.transpose();
  position_ = scan.T_world_sensor.translation();
  first_.assign(size() + 1, 0);
  thread_local std::vector<std::int32_t> bin_of;
  bin_of.resize(scan.size());
  for (std::size_t k = 0; k < scan.size(); ++k) {
    const Eigen::Vector3f& p = scan.points[k];
    const float flat = std::sqrt(p.x() * p.x() + p.y() * p.y());
    const int row = floor_of(elevation_bin(p, flat));
    const int column = std::clamp(static_cast<int>(azimuth_bin(p)), 0, columns_ - 1);
    const bool is_beam = row >= 0 && row < rows_ && p.squaredNorm() >= nearest_ * nearest_;
    bin_of[k] = is_beam ? row * columns_ + column : -1;
    if (is_beam) ++first_[static_cast<std::size_t>(bin_of[k]) + 1];
  }
  for (std::size_t b = 1; b < first_.size(); ++b) first_[b] += first_[b - 1];
  beams_.resize(first_.back());
  point_of_.resize(beams_.size());
  for (std::size_t k = scan.size(); k-- > 0;) {
    if (bin_of[k] < 0) continue;
    const float range = scan.points[k].norm();
    const Eigen::Vector3f direction = R_world_sensor * scan.points[k] / range;
    const std::uint32_t place = --first_[static_cast<std::size_t>(bin_of[k]) + 1];
    beams_[place] = {direction.x(), direction.y(), direction.z(), range};
    point_of_[place] = static_cast<std::uint32_t>(k);
  }
  // Now `first_[b + 1]` is the first beam of bin b.
  for (std::size_t b = 0; b + 1 < first_.size(); ++b) first_[b] = first_[b + 1];
  first_.back() = static_cast<std::uint32_t>(beams_.size());
  find_farthest();
}

const BeamImage::Beam* BeamImage::neighbour(int row, int column, int rows, int columns,
                                            const Beam& of) const {
  // Rows of half the sensor's step may be empty, and rings lean.
  const int farthest = rows != 0 ? 3 : 2, sides = rows != 0 ? 3 : 1;
  for (int i = 1; i <= farthest; ++i) {
    const int r = row + i * rows;
    if (r < 0 || r >= rows_) return nullptr;
    for (int side = 0; side < sides; ++side) {
      const int c = wrapped(column + i * columns + (side == 2 ? -1 : side));
      const std::span<const Beam> others = beams(r, c, c);
      if (others.empty()) continue;
      return &*std::min_element(
          others.begin(), others.end(), [&](const Beam& one, const Beam& two) {
            return std::abs(one.range - of.range) < std::abs(two.range - of.range);
          });
    }
  }
  return nullptr;
}

void BeamImage::find_extensions(std::vector<Extension>& extensions) const {
  extensions.clear();
  const auto position = [](const Beam& b) {
    return Eigen::Vector3f(b.x * b.range, b.y * b.range, b.z * b.range);
  };
  static constexpr int kRows[4] = {1, -1, 0, 0}, kColumns[4] = {0, 0, 1, -1};
  for (int bin = 0; bin < static_cast<int>(size()); ++bin) {
    const int row = bin / columns_, column = bin % columns_;
    for (const Beam& beam : beams(row, column, column)) {
      for (int n = 0; n < 4; ++n) {
        const float step = kRows[n] != 0 ? 2.0F * elevation_step_ : azimuth_step_;
        if (step * beam.range < kLeastGap) continue;
        const Beam* const other = neighbour(row, column, kRows[n], kColumns[n], beam);
        if (other == nullptr) continue;
        const Eigen::Vector3f offset = position(*other) - position(beam);
        const float deeper = std::abs(other->range - beam.range);
        const float aside = std::sqrt(std::max(offset.squaredNorm() - deeper * deeper, 0.0F));
        const bool goes_on = aside >= kLeastGap && aside <= kMostGap &&
                             deeper <= std::min(aside + kDeeper, kMostDeeper);
        if (goes_on) extensions.push_back({point_of_[&beam - beams_.data()], offset / 3.0F});
      }
    }
  }
}

void BeamImage::find_farthest() {
  farthest_.assign(static_cast<std::size_t>((rows_ >> kBlockShift) + 1) *
                       static_cast<std::size_t>(block_columns_),
                   0.0F);
  for (int r = 0; r < rows_; ++r) {
    for (int c = 0; c < columns_; ++c) {
      float& farthest = farthest_[static_cast<std::size_t>((r >> kBlockShift) * block_columns_ +
                                                           (c >> kBlockShift))];
      for (const Beam& beam : beams(r, c, c)) farthest = std::max(farthest, beam.range);
    }
  }
}

bool BeamImage::is_hidden(const Window& window, float range) const {
  for (int r = window.row0 >> kBlockShift; r <= window.row1 >> kBlockShift; ++r) {
    for (int c = window.column0;; c = std::min(c + (1 << kBlockShift), window.column1)) {
      if (farthest_[static_cast<std::size_t>(r * block_columns_ + (wrapped(c) >> kBlockShift))] >=
          range)
        return false;
      if (c == window.column1) break;
    }
  }
  return true;
}

bool BeamImage::is_open(float row, float column, float range) const {
  const int c0 = floor_of(column), r0 = floor_of(row);
  bool above = false, below = false;
  for (int r = std::max(r0 - 2, 0); r <= std::min(r0 + 2, rows_ - 1); ++r) {
    for (int c = c0 - 1; c <= c0 + 1; ++c) {
      for (const Beam& b : beams(r, wrapped(c), wrapped(c))) {
        if (b.range < range) return false;
        above |= r >= r0;
        below |= r <= r0;
      }
    }
  }
  return above && below;
}

BeamImage::Window BeamImage::window_around(const Eigen::Vector3f& mean, float range,
                                           float radius) const {
  const Eigen::Vector3f s = R_sensor_world_ * mean;
  const float flat = std::sqrt(s.x() * s.x() + s.y() * s.y());
  const float half = kWindow * radius, high = half / range / elevation_step_;
  const float row = elevation_bin(s, flat), column = azimuth_bin(s);
  const int row0 = std::max(floor_of(row - high), 0);
  const int row1 = std::min(floor_of(row + high), rows_ - 1);
  // Around the axis a voxel is in all columns.
  if (half >= 0.5F * flat) return {row, column, row0, row1, 0, columns_ - 1};
  // The arc sine of up to a half is at most 1.05 of it.
  const float wide = 1.05F * half / flat / azimuth_step_;
  return {row, column, row0, row1, floor_of(column - wide), floor_of(column + wide)};
}

/// What the beams of a window say of a voxel: whether any comes near it, and whether any passes
/// through it or ends there.
struct BeamImage::Meeting {
  const VoxelShape& shape;
  const Eigen::Vector3f mean, weighted;  ///< From the sensor, and times the inverse covariance.
  const float square, away;              ///< Of the distance, square metres and squared deviations.
  const float plane;  ///< How far the plane of a flat voxel is from the sensor, metres.
  const float hit, pass;
  const float nearest, farthest;  ///< Ranges between which a beam may hit, metres.
  bool is_hit = false, is_passed = false, is_crossed = false;

  [[nodiscard]] bool ends_behind_plane(const Beam& b) const {
    if (shape.behind == 0.0F) return true;
    const float end = b.range * (shape.nx * b.x + shape.ny * b.y + shape.nz * b.z) - plane;
    return plane > 0.0F ? end > shape.behind : end < -shape.behind;
  }

  /// Stops at the first beam that hits: nothing outweighs it.
  void test(std::span<const Beam> beams) {
    const float widest = square - kMeets * shape.radius * shape.radius - kSquareRounding * square;
    for (const Beam& b : beams) {
      const float ahead = b.x * mean.x() + b.y * mean.y() + b.z * mean.z();
      if (b.range < nearest || (is_passed && b.range > farthest)) continue;
      if (ahead * ahead < widest) continue;
      const float along = b.x * weighted.x() + b.y * weighted.y() + b.z * weighted.z();
      const float norm =
          shape.xx * b.x * b.x + shape.yy * b.y * b.y + shape.zz * b.z * b.z +
          2.0F * (shape.xy * b.x * b.y + shape.xz * b.x * b.z + shape.yz * b.y * b.z);
      const float aside = away - along * along / norm;
      if (aside > kMeets) continue;
      is_crossed = true;
      const float behind = b.range - along / norm;
      if (std::abs(behind) <= hit) {
        is_hit = true;
        return;
      }
      is_passed |= behind > pass && aside <= kCrosses && ends_behind_plane(b);
    }
  }
};

void BeamImage::meet(const Window& window, Meeting& meeting) const {
  const int rows = window.row1 - window.row0 + 1, middle = window.row0 + (rows - 1) / 2;
  // The rows in the middle are the likeliest to hit.
  for (int i = 0; i < rows && !meeting.is_hit; ++i) {
    const int row = i % 2 == 0 ? middle - i / 2 : middle + (i + 1) / 2;
    if (window.column0 < 0) {
      meeting.test(beams(row, 0, window.column1));
      if (!meeting.is_hit) meeting.test(beams(row, window.column0 + columns_, columns_ - 1));
    } else if (window.column1 >= columns_) {
      meeting.test(beams(row, window.column0, columns_ - 1));
      if (!meeting.is_hit) meeting.test(beams(row, 0, window.column1 - columns_));
    } else {
      meeting.test(beams(row, window.column0, window.column1));
    }
  }
}

void BeamImage::observe(std::span<const float> places, std::span<const VoxelShape> shapes,
                        const Eigen::Vector3d& origin, std::vector<ObservedVoxel>& observed) const {
  observed.clear();
  const Eigen::Vector3f from = (origin - position_).cast<float>();
  for (std::size_t v = 0; v < shapes.size(); ++v) {
    const Eigen::Vector3f m =
        from + Eigen::Vector3f(places[3 * v], places[3 * v + 1], places[3 * v + 2]);
    const float square = m.squaredNorm();
    if (square < range_min_ * range_min_ || square > range_max_ * range_max_) continue;
    const float range = std::sqrt(square);
    const VoxelShape& shape = shapes[v];
    const Window window = window_around(m, range, shape.radius);
    const float slope = static_cast<float>(Parameters::distance_slope) * range;
    const float hit = hit_ + slope, nearest = range - hit - kWindow * shape.radius;
    if (window.row0 > window.row1 || is_hidden(window, nearest)) continue;
    const Eigen::Vector3f w(shape.xx * m.x() + shape.xy * m.y() + shape.xz * m.z(),
                            shape.xy * m.x() + shape.yy * m.y() + shape.yz * m.z(),
                            shape.xz * m.x() + shape.yz * m.y() + shape.zz * m.z());
    const float plane = shape.nx * m.x() + shape.ny * m.y() + shape.nz * m.z();
    Meeting meeting{shape,    m,
                    w,        square,
                    w.dot(m), plane,
                    hit,      pass_ + slope,
                    nearest,  range + hit + kWindow * shape.radius};
    meet(window, meeting);
    const auto say = [&](Observation observation) {
      observed.push_back({static_cast<std::uint32_t>(v), observation, range});
    };
    if (meeting.is_hit) {
      say(Observation::kHit);
    } else if (meeting.is_passed) {
      say(Observation::kPassed);
    } else if (!meeting.is_crossed && range <= kFarther * shape.nearest &&
               2.0F * elevation_step_ * range > kRowGap &&
               is_open(window.row, window.column, range + meeting.pass)) {
      say(Observation::kOpen);
    }
  }
}

}  // namespace raymoval::raymoval_plus_method
