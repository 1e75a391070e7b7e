// SPDX-License-Identifier: MIT
#include "methods/dynablox/range_image.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/angle.h"

namespace raymoval::dynablox_method {
namespace {

constexpr int kMostColumns = 16384, kMostRows = 1024;

/// How many steps make up `whole`, as published if the step is unknown.
int steps_in(double whole, double step, int published, int most) {
  if (!(step > 0.0)) return published;
  return static_cast<int>(std::clamp(std::round(whole / step), 1.0, static_cast<double>(most)));
}

/// Whether a sensor can see from one elevation to the other; not if one is unknown.
bool is_view(double low, double high) {
  return std::abs(low) <= kTurn / 4.0 && std::abs(high) <= kTurn / 4.0 && low < high;
}

}  // namespace

ImageGrid::ImageGrid(const Parameters& parameters, const SensorModel& sensor) {
  const Parameters published;
  const bool is_fixed = parameters.image == ImageSource::kFixed;
  double low = -0.5 * (is_fixed ? parameters : published).vertical_view * kDegree, high = -low;
  columns = parameters.image_columns;
  rows = parameters.image_rows;
  if (!is_fixed) {
    if (is_view(sensor.elevation_min, sensor.elevation_max)) {
      low = sensor.elevation_min;
      high = std::max(sensor.elevation_max, low + kDegree);
    }
    columns = steps_in(kTurn, sensor.azimuth_step, published.image_columns, kMostColumns);
    rows = 1 + steps_in(high - low, sensor.elevation_step, published.image_rows - 1, kMostRows);
  }
  columns_per_radian = static_cast<float>(columns / kTurn);
  rows_per_radian = static_cast<float>((rows - 1) / (high - low));
  elevation_min = static_cast<float>(low);
  pixels_per_square_radian = static_cast<float>(columns / kTurn * rows / (high - low));
}

template <class Visit>
void RangeImage::for_pixels(const Scan& scan, const kernels::Projection& job, Visit&& visit) {
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  const std::size_t lanes = kernels_.most_lanes, points = scan.size();
  const std::size_t whole = points - points % lanes;
  pixels_.resize(whole + lanes);
  seen_.resize(whole + lanes);
  if (whole > 0) {
    kernels_.project(job, scan.points.front().data(), whole, pixels_.data(), seen_.data());
  }
  // The rest, with points at the origin behind them, which are in no pixel.
  std::vector<Eigen::Vector3f> rest(scan.points.begin() + static_cast<std::ptrdiff_t>(whole),
                                    scan.points.end());
  rest.resize(lanes, Eigen::Vector3f::Zero());
  kernels_.project(job, rest.front().data(), lanes, pixels_.data() + whole, seen_.data() + whole);
  for (std::size_t k = 0; k < points; ++k) {
    if (pixels_[k] >= 0) visit(pixels_[k], seen_[k]);
  }
}

void RangeImage::fill(const Scan& scan, const Parameters& parameters, float max_range) {
  const auto stored_columns = static_cast<std::size_t>(grid_.columns + 1);
  ranges_.assign(stored_columns * static_cast<std::size_t>(grid_.rows + 2), 0.0F);
  const bool far = parameters.clearing != FarReturns::kNothing;
  constexpr float kAny = std::numeric_limits<float>::max();
  const kernels::Projection job{.columns = grid_.columns,
                                .rows = grid_.rows,
                                .columns_per_radian = grid_.columns_per_radian,
                                .rows_per_radian = grid_.rows_per_radian,
                                .elevation_min = grid_.elevation_min,
                                .min_range = static_cast<float>(parameters.min_range),
                                .max_range = far ? kAny : max_range};
  // A voxel within `max_range` is at the full distance before what is beyond this.
  const float furthest = parameters.interpolation == Interpolation::kMean
                             ? max_range + static_cast<float>(parameters.truncation)
                             : kAny;
  for_pixels(scan, job, [&](std::int32_t pixel, float range) {
    float& stored = ranges_[static_cast<std::size_t>(pixel)];
    const float seen = std::min(range, furthest);
    stored = stored == 0.0F ? seen : std::min(stored, seen);
  });
  for (int row = 0; row < grid_.rows; ++row) {
    ranges_[grid_.stored(grid_.columns, row)] = ranges_[grid_.stored(0, row)];
  }
}

}  // namespace raymoval::dynablox_method
