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
/// Bounds of an image: the finest sensors of today need half of these bins. A step that is none
/// (of a model written by hand, or a hopeless estimate) costs no more memory.
constexpr double kLeastBin = 0.01 * kDegree;
constexpr int kMostBins = 4'000'000;

/// Room for what the kernels say of places; one for each thread.
struct Sights {
  AlignedArray<float> range;
  AlignedArray<std::int32_t> column, row;
  AlignedArray<std::uint32_t> chosen;

  kernels::Sights room_for(std::size_t places) {
    constexpr std::size_t kMostLanes = 16;
    range.require(places + kMostLanes);
    column.require(places + kMostLanes);
    row.require(places + kMostLanes);
    chosen.require(places);
    return {range.data(), column.data(), row.data()};
  }
};

kernels::SightPlaces in_sensor_frame(const float* places, std::size_t count, const Pose& pose) {
  kernels::SightPlaces job{places, count, {}, {}};
  for (std::size_t i = 0; i < 9; ++i) {
    job.rotation[i] = static_cast<float>(
        pose.linear()(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3)));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    job.translation[i] = static_cast<float>(pose.translation()[static_cast<Eigen::Index>(i)]);
  }
  return job;
}

}  // namespace

RangeImage::RangeImage(const SensorModel& sensor, const RaymovalPlusParameters& parameters,
                       InstructionSet set)
    : parameters_(parameters),
      kernels_(kernels::sight_kernels_for(set)),
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
      std::max(parameters.elevation_bin > 0.0 ? parameters.elevation_bin * kDegree : elevation_step,
               kLeastBin);
  columns_ = static_cast<int>(
      std::clamp(std::round(2.0 * std::numbers::pi / wanted_azimuth), 90.0, 7200.0));
  azimuth_step_ = 2.0F * kPi / static_cast<float>(columns_);
  const double margin = 4.0 * wanted_elevation;
  const double low = std::max(sensor.elevation_min - margin, -std::numbers::pi / 2.0);
  const double high = std::min(sensor.elevation_max + margin, std::numbers::pi / 2.0);
  // Rows are as high as they are to be, whatever the field of view: beams that fall on every second
  // row do so in all rows.
  constexpr double kRounding = 1e-6;
  const int kMostRows = kMostBins / columns_;
  const double rows = std::ceil((high - low) / wanted_elevation - kRounding);
  rows_ = static_cast<int>(std::clamp(rows, 1.0, static_cast<double>(kMostRows)));
  elevation_step_ =
      static_cast<float>(rows > kMostRows ? (high - low) / kMostRows : wanted_elevation);
  stride_ = columns_ + 2 * kMargin;
  grid_ = {1.0F / azimuth_step_, 1.0F / elevation_step_, static_cast<float>(low), columns_};
}

void RangeImage::fill(const Scan& scan) {
  bins_.assign(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(stride_),
               {kInfinite, -kInfinite});
  Sights sights;
  kernels_.locate(grid_,
                  in_sensor_frame(scan.points.empty() ? nullptr : scan.points.front().data(),
                                  scan.size(), Pose::Identity()),
                  sights.room_for(scan.size()));
  for (std::size_t k = 0; k < scan.size(); ++k) {
    const float range = sights.range[k];
    const int r = sights.row[k];
    if (range < static_cast<float>(parameters_.minimum_range) || r < 0 || r >= rows_) continue;
    Bin& bin = bins_[static_cast<std::size_t>(r) * static_cast<std::size_t>(stride_) +
                     static_cast<std::size_t>(sights.column[k] + kMargin)];
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

Seen RangeImage::test(const Eigen::Vector3f& place) const {
  Sights sights;
  kernels_.locate(grid_, in_sensor_frame(place.data(), 1, Pose::Identity()), sights.room_for(1));
  const float range = sights.range[0];
  const int r = sights.row[0];
  const auto [wide, high] = window_at(range);
  bool agrees = false, occluded = false, below = false;
  for (int at = std::max(r - high, 0); at <= std::min(r + high, rows_ - 1); ++at) {
    for (int c = -wide; c <= wide; ++c) {
      const Bin bin = row(bins_, at)[kMargin + sights.column[0] + c];
      agrees |= agrees_with(range, bin);
      occluded |= bin.nearest < range + occluded_constant_ + occluded_slope_ * range;
      below |= bin.nearest < kInfinite && at <= r;
    }
  }
  if (agrees) return Seen::kAgree;
  if (occluded) return Seen::kOccluded;
  return below ? Seen::kFree : Seen::kUnknown;
}

void RangeImage::see(const std::vector<float>& places, const Pose& T_sensor_places,
                     std::vector<SeenPlace>& seen) const {
  thread_local Sights sights;
  const std::size_t count = places.size() / 3;
  kernels::SightWindows windows;
  windows.pairs = &windows_.front().nearest;
  windows.stride = stride_;
  windows.margin = kMargin;
  windows.rows = rows_;
  // A little farther than where windows grow: roundings may go either way.
  windows.least_range = 1.001F * half_voxel_ /
                        std::min(azimuth_step_ * static_cast<float>(parameters_.window_columns + 1),
                                 elevation_step_ * static_cast<float>(parameters_.window_rows + 1));
  windows.agree[0] = agree_constant_;
  windows.agree[1] = agree_slope_;
  windows.range_min = static_cast<float>(parameters_.evidence_range_min);
  windows.range_max = static_cast<float>(parameters_.evidence_range_max);
  const kernels::Sights room = sights.room_for(count);
  const std::size_t chosen =
      kernels_.choose(grid_, in_sensor_frame(places.data(), count, T_sensor_places), windows, room,
                      sights.chosen.data());
  seen.clear();
  for (std::size_t i = 0; i < chosen; ++i) {
    const std::uint32_t k = sights.chosen[i];
    const float range = sights.range[k];
    const Seen says = look(range, sights.column[k], sights.row[k]);
    if (says == Seen::kAgree || says == Seen::kFree) seen.push_back({k, says, range});
  }
}

Seen RangeImage::look(float range, int column, int r) const {
  const auto [wide, high] = window_at(range);
  const float agree = agree_constant_ + agree_slope_ * range;
  const float beyond = range + occluded_constant_ + occluded_slope_ * range;
  const float farther = std::max(range + agree, beyond);
  const std::ptrdiff_t place = kMargin + column;
  bool occluded = false, below = false;
  for (int at = std::max(r - high, 0); at <= std::min(r + high, rows_ - 1); ++at) {
    if (wide == parameters_.window_columns) {
      // Few rows have returns at about the place's range.
      const Bin all = row(row_windows_, at)[place];
      const bool hides = all.farthest < range - agree;
      if (hides || all.nearest > farther) {
        occluded |= all.nearest < beyond;
        below |= all.nearest < kInfinite && at <= r;
        continue;
      }
    }
    const Bin* const bins = row(bins_, at) + place;
    for (int c = -wide; c <= wide; ++c) {
      if (agrees_with(range, bins[c])) return Seen::kAgree;
      occluded |= bins[c].nearest < beyond;
      below |= bins[c].nearest < kInfinite && at <= r;
    }
  }
  if (occluded) return Seen::kOccluded;
  return below ? Seen::kFree : Seen::kUnknown;
}

}  // namespace raymoval
