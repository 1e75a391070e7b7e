// SPDX-License-Identifier: MIT
#include "methods/dynablox/range_image.h"

#include <algorithm>

#include "core/angle.h"

namespace raymoval::dynablox_method {
namespace {

constexpr int kMostColumns = 16384, kMostRows = 1024;

/// How many steps make up `whole`, as published if the step is unknown.
int steps_in(double whole, double step, int published, int most) {
  if (!(step > 0.0)) return published;
  return static_cast<int>(std::clamp(std::round(whole / step), 1.0, static_cast<double>(most)));
}

}  // namespace

float arc_tangent(float y, float x) {
  const float across = std::abs(x), up = std::abs(y);
  const float most = std::max(across, up);
  const float a = std::min(across, up) / std::max(most, kLeastDivisor);
  const float square = a * a;
  float sum = kArcTangent[6];
  for (std::size_t k = 6; k-- > 0;) sum = sum * square + kArcTangent[k];
  float angle = sum * a;
  if (up > across) angle = kQuarterTurn - angle;
  if (x < 0.0F) angle = kHalfTurn - angle;
  return std::copysign(angle, y);
}

ImageGrid::ImageGrid(const Parameters& parameters, const SensorModel& sensor) {
  const Parameters published;
  double low = -0.5 * parameters.vertical_view * kDegree, high = -low;
  columns = parameters.image_columns;
  rows = parameters.image_rows;
  if (parameters.image == ImageSource::kSensor) {
    low = sensor.elevation_min;
    high = std::max(sensor.elevation_max, low + kDegree);
    columns = steps_in(kTurn, sensor.azimuth_step, published.image_columns, kMostColumns);
    rows = 1 + steps_in(high - low, sensor.elevation_step, published.image_rows - 1, kMostRows);
  }
  columns_per_radian = static_cast<float>(columns / kTurn);
  rows_per_radian = static_cast<float>((rows - 1) / (high - low));
  elevation_min = static_cast<float>(low);
}

void RangeImage::fill(const Scan& scan, const Parameters& parameters, float max_range) {
  const auto stored_columns = static_cast<std::size_t>(grid_.columns + 1);
  ranges_.assign(stored_columns * static_cast<std::size_t>(grid_.rows + 2), 0.0F);
  const auto nearest = static_cast<float>(parameters.min_range);
  // A voxel within `max_range` is at the full distance before what is beyond this.
  const float furthest = max_range + static_cast<float>(parameters.truncation);
  for (const Eigen::Vector3f& p : scan.points) {
    const float level = std::sqrt(p.x() * p.x() + p.y() * p.y());
    const float range = std::sqrt(p.x() * p.x() + p.y() * p.y() + p.z() * p.z());
    if (!(range >= nearest && range > 0.0F)) continue;
    if (range > max_range && !parameters.clearing) continue;
    const float u = (arc_tangent(p.y(), p.x()) + kHalfTurn) * grid_.columns_per_radian;
    const float v = (arc_tangent(p.z(), level) - grid_.elevation_min) * grid_.rows_per_radian;
    const int row = static_cast<int>(std::floor(v + 0.5F));
    if (row < 0 || row >= grid_.rows) continue;
    const int column = std::min(static_cast<int>(u), grid_.columns - 1);
    float& pixel = ranges_[grid_.stored(column, row)];
    const float seen = std::min(range, furthest);
    pixel = pixel == 0.0F ? seen : std::min(pixel, seen);
  }
  for (int row = 0; row < grid_.rows; ++row) {
    ranges_[grid_.stored(grid_.columns, row)] = ranges_[grid_.stored(0, row)];
  }
}

}  // namespace raymoval::dynablox_method
