// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/range_image.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace raymoval {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kInfinite = std::numeric_limits<float>::infinity();
constexpr double kDegree = std::numbers::pi / 180.0;
/// A bin is a little wider than a beam, so that few bins stay empty where a surface goes on.
constexpr double kBeamsPerColumn = 1.45;

}  // namespace

RangeImage::RangeImage(const SensorModel& sensor, const RaymovalPlusParameters& parameters)
    : parameters_(parameters) {
  const double azimuth_step =
      sensor.azimuth_step > 0.0 ? kBeamsPerColumn * sensor.azimuth_step : 0.25 * kDegree;
  const double elevation_step =
      sensor.elevation_step > 0.0 ? 0.5 * sensor.elevation_step : 0.2 * kDegree;
  const double wanted_azimuth =
      parameters.azimuth_bin > 0.0 ? parameters.azimuth_bin * kDegree : azimuth_step;
  const double wanted_elevation =
      parameters.elevation_bin > 0.0 ? parameters.elevation_bin * kDegree : elevation_step;
  columns_ =
      std::clamp(static_cast<int>(std::lround(2.0 * std::numbers::pi / wanted_azimuth)), 90, 7200);
  azimuth_step_ = 2.0F * kPi / static_cast<float>(columns_);
  const double margin = 4.0 * wanted_elevation;
  const double low = std::max(sensor.elevation_min - margin, -std::numbers::pi / 2.0);
  const double high = std::min(sensor.elevation_max + margin, std::numbers::pi / 2.0);
  rows_ = std::clamp(static_cast<int>(std::ceil((high - low) / wanted_elevation)), 1, 3600);
  elevation_step_ = static_cast<float>((high - low) / rows_);
  elevation_min_ = static_cast<float>(low);
  stride_ = columns_ + 2 * kMargin;
}

void RangeImage::fill(const Scan& scan) {
  bins_.assign(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(stride_),
               {kInfinite, -kInfinite});
  for (const Eigen::Vector3f& point : scan.points) {
    const float range = point.norm();
    if (range < static_cast<float>(parameters_.minimum_range)) continue;
    const int column = std::min(
        static_cast<int>((std::atan2(point.y(), point.x()) + kPi) / azimuth_step_), columns_ - 1);
    const int r = static_cast<int>(
        std::floor((std::asin(point.z() / range) - elevation_min_) / elevation_step_));
    if (r < 0 || r >= rows_) continue;
    Bin& bin = bins_[static_cast<std::size_t>(r) * static_cast<std::size_t>(stride_) +
                     static_cast<std::size_t>(column + kMargin)];
    bin.nearest = std::min(bin.nearest, range);
    bin.farthest = std::max(bin.farthest, range);
  }
  for (int r = 0; r < rows_; ++r) {
    Bin* const bins =
        bins_.data() + static_cast<std::size_t>(r) * static_cast<std::size_t>(stride_);
    std::copy_n(bins + columns_, kMargin, bins);
    std::copy_n(bins + kMargin, kMargin, bins + kMargin + columns_);
  }
}

Seen RangeImage::test(const Eigen::Vector3f& place) const {
  const float range = place.norm();
  const int column = std::min(
      static_cast<int>((std::atan2(place.y(), place.x()) + kPi) / azimuth_step_), columns_ - 1);
  const int center = static_cast<int>(
      std::floor((std::asin(place.z() / range) - elevation_min_) / elevation_step_));
  const float half = 0.5F * static_cast<float>(parameters_.voxel_size) / range;
  const int wide =
      std::clamp(static_cast<int>(half / azimuth_step_), parameters_.window_columns, kMargin - 1);
  const int high = std::max(static_cast<int>(half / elevation_step_), parameters_.window_rows);
  const int low_row = std::max(center - high, 0), high_row = std::min(center + high, rows_ - 1);

  const float agree = static_cast<float>(parameters_.agree_constant) +
                      static_cast<float>(parameters_.agree_slope) * range;
  const float beyond = range + static_cast<float>(parameters_.occluded_constant) +
                       static_cast<float>(parameters_.occluded_slope) * range;
  bool agrees = false, occluded = false, below = false;
  for (int r = low_row; r <= high_row; ++r) {
    const Bin* const bins = row(r) + kMargin + column;
    bool any = false;
    for (int c = -wide; c <= wide; ++c) {
      const Bin bin = bins[c];
      agrees |= std::abs(bin.nearest - range) <= agree || std::abs(bin.farthest - range) <= agree;
      occluded |= bin.nearest < beyond;
      any |= bin.nearest < kInfinite;
    }
    below |= any && r <= center;
  }
  if (agrees) return Seen::kAgree;
  if (occluded) return Seen::kOccluded;
  return below ? Seen::kFree : Seen::kUnknown;
}

}  // namespace raymoval
