// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/range_image.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/angle.h"

namespace raymoval {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kInfinite = std::numeric_limits<float>::infinity();
/// A bin is a little wider than a beam, so that few bins stay empty where a surface goes on.
constexpr double kBeamsPerColumn = 1.45;

}  // namespace

RangeImage::RangeImage(const SensorModel& sensor, const RaymovalPlusParameters& parameters)
    : parameters_(parameters),
      half_voxel_(static_cast<float>(0.5 * parameters.voxel_size)),
      agree_constant_(static_cast<float>(parameters.agree_constant)),
      agree_slope_(static_cast<float>(parameters.agree_slope)),
      occluded_constant_(static_cast<float>(parameters.occluded_constant)),
      occluded_slope_(static_cast<float>(parameters.occluded_slope)) {
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
  fill_windows();
}

void RangeImage::fill_windows() {
  const auto widest = [](Bin& sum, const Bin& bin) {
    sum.nearest = std::min(sum.nearest, bin.nearest);
    sum.farthest = std::max(sum.farthest, bin.farthest);
  };
  const int wide = std::min(parameters_.window_columns, kMargin - 1);
  const int high = std::min(parameters_.window_rows, rows_ - 1);
  row_windows_ = bins_;
  for (int r = 0; r < rows_; ++r) {
    Bin* const to =
        row_windows_.data() + static_cast<std::size_t>(r) * static_cast<std::size_t>(stride_);
    const Bin* const from = row(bins_, r);
    for (int shift = -wide; shift <= wide; ++shift) {
      if (shift == 0) continue;
      for (int c = wide; c < stride_ - wide; ++c) widest(to[c], from[c + shift]);
    }
  }
  windows_ = row_windows_;
  for (int r = 0; r < rows_; ++r) {
    Bin* const to =
        windows_.data() + static_cast<std::size_t>(r) * static_cast<std::size_t>(stride_);
    for (int other = std::max(r - high, 0); other <= std::min(r + high, rows_ - 1); ++other) {
      if (other == r) continue;
      const Bin* const from = row(row_windows_, other);
      for (int c = 0; c < stride_; ++c) widest(to[c], from[c]);
    }
  }
}

RangeImage::Window RangeImage::window_of(const Eigen::Vector3f& place, float range) const {
  const int column = std::min(
      static_cast<int>((std::atan2(place.y(), place.x()) + kPi) / azimuth_step_), columns_ - 1);
  const int center = static_cast<int>(
      std::floor((std::asin(place.z() / range) - elevation_min_) / elevation_step_));
  const float half = half_voxel_ / range;
  const int wide =
      std::clamp(static_cast<int>(half / azimuth_step_), parameters_.window_columns, kMargin - 1);
  const int high = std::max(static_cast<int>(half / elevation_step_), parameters_.window_rows);
  return {column, center, wide, high};
}

Seen RangeImage::test(const Eigen::Vector3f& place) const {
  const float range = place.norm();
  const Window window = window_of(place, range);
  if (window.wide == parameters_.window_columns && window.high == parameters_.window_rows &&
      window.center >= 0 && window.center < rows_) {
    // Most places lie behind all returns of their window.
    const Bin all = row(windows_, window.center)[kMargin + window.column];
    if (all.nearest == kInfinite) return Seen::kUnknown;
    if (all.farthest < range - (agree_constant_ + agree_slope_ * range)) return Seen::kOccluded;
  }
  return test_bins(range, window);
}

Seen RangeImage::test_every_bin(const Eigen::Vector3f& place) const {
  const float range = place.norm();
  return test_bins(range, window_of(place, range));
}

Seen RangeImage::test_bins(float range, const Window& window) const {
  const auto [column, center, wide, high] = window;
  const int low_row = std::max(center - high, 0), high_row = std::min(center + high, rows_ - 1);

  const float agree = agree_constant_ + agree_slope_ * range;
  const float beyond = range + occluded_constant_ + occluded_slope_ * range;
  bool agrees = false, occluded = false, below = false;
  for (int r = low_row; r <= high_row; ++r) {
    const Bin* const bins = row(bins_, r) + kMargin + column;
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
