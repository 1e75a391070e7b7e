// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/range_image.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "core/simd/simd.h"

namespace raymoval::raymoval_plus_method {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

// Numbers of this step. The parameters azimuth_bin and elevation_bin replace the first two, and
/// A bin is a little wider than a beam, so that few bins stay empty where a surface goes on.
constexpr double kBeamsPerColumn = 1.45;
/// A bin is half as high as beams are apart, so that two beams that are not quite evenly spaced do
/// not share a row; the window of two rows to either side spans two beams.
constexpr double kBeamsPerRow = 0.5;
/// The size of a bin for a sensor whose steps are not known: about that of 64 beams.
constexpr double kUnknownColumn = 0.25 * kDegree, kUnknownRow = 0.2 * kDegree;
/// Rows beyond either end of the field of view, for the windows of places just outside it.
constexpr double kMarginRows = 4.0;
/// Columns that are repeated at either end, so that no window has to wrap around. They limit
/// `window_columns` to 30.
constexpr int kMargin = 32;
/// Bounds of an image. The finest sensors of today need half of these bins. A step that no sensor
/// has (in a model written by hand, or by a hopeless estimate) costs no more memory.
constexpr double kLeastRow = 0.01 * kDegree, kFewestColumns = 90.0, kMostColumns = 7200.0;
constexpr int kMostBins = 4'000'000;
/// 30 degrees in rows of 1 degree are 30 rows, also if their quotient is a little more.
constexpr double kRowRounding = 1e-6;
/// Metres by which the range of returns that might agree is made larger than it is. Differences of
/// ranges are rounded by less.
constexpr float kRangeRounding = 1e-3F;

/// Memory for what the kernels say of places; each thread has its own.
struct SightRoom {
  AlignedArray<float> range;
  AlignedArray<std::int32_t> column, row, sighted;
  AlignedArray<std::uint32_t> place, unsure;

  kernels::ChosenSights room_for(std::size_t places) {
    for (AlignedArray<std::int32_t>* const array : {&column, &row, &sighted}) {
      array->require(places + kernels::kMostLanes);
    }
    range.require(places + kernels::kMostLanes);
    place.require(places + kernels::kMostLanes);
    unsure.require(places + kernels::kMostLanes);
    return {place.data(), sighted.data(), {range.data(), column.data(), row.data()}};
  }
};
thread_local SightRoom sight_room;

kernels::SightPlaces in_sensor_frame(const float* places, std::size_t count, const Pose& pose) {
  kernels::SightPlaces job{places, count, {}, {}};
  Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(job.rotation.data()) =
      pose.linear().cast<float>();
  Eigen::Map<Eigen::Vector3f>(job.translation.data()) = pose.translation().cast<float>();
  return job;
}

/// Whether a return of the window of a place agrees with it or hides it.
bool is_met(Observation observation) {
  return observation == Observation::kAgree || observation == Observation::kOccluded;
}

/// The `n`th of 0, -1, 1, -2, 2, ...: the middle of a window tells the most.
int from_the_middle(int n) {
  return n % 2 == 0 ? n / 2 : -(n + 1) / 2;
}

kernels::Sighted sighted_at(const kernels::ChosenSights& chosen, std::size_t i) {
  return static_cast<kernels::Sighted>(chosen.sighted[i]);
}

}  // namespace

RangeImage::RangeImage(const SensorModel& sensor, const Parameters& parameters)
    : parameters_(parameters),
      has_even_beams_(has_even_beams(sensor)),
      half_voxel_(static_cast<float>(0.5 * parameters.voxel_size)),
      agree_{static_cast<float>(parameters.agree_constant),
             static_cast<float>(parameters.agree_slope)},
      occluded_{static_cast<float>(parameters.occluded_constant),
                static_cast<float>(parameters.occluded_slope)} {
  choose_steps(sensor);
}

void RangeImage::choose_steps(const SensorModel& sensor) {
  const double azimuth_beam =
      sensor.azimuth_step > 0.0 ? kBeamsPerColumn * sensor.azimuth_step : kUnknownColumn;
  const double elevation_beam =
      sensor.elevation_step > 0.0 ? kBeamsPerRow * sensor.elevation_step : kUnknownRow;
  const double width =
      parameters_.azimuth_bin > 0.0 ? parameters_.azimuth_bin * kDegree : azimuth_beam;
  const double height = std::max(
      parameters_.elevation_bin > 0.0 ? parameters_.elevation_bin * kDegree : elevation_beam,
      kLeastRow);
  const int columns = static_cast<int>(
      std::clamp(std::round(2.0 * std::numbers::pi / width), kFewestColumns, kMostColumns));
  azimuth_step_ = 2.0F * kPi / static_cast<float>(columns);
  const double low = std::max(sensor.elevation_min - kMarginRows * height, -std::numbers::pi / 2.0);
  const double high = std::min(sensor.elevation_max + kMarginRows * height, std::numbers::pi / 2.0);
  // Rows are as high as they are to be, whatever the field of view is. If beams fall on every
  // second row, they then do so in all of the image.
  const int most_rows = kMostBins / columns;
  const double rows = std::ceil((high - low) / height - kRowRounding);
  image_.rows = static_cast<int>(std::clamp(rows, 1.0, static_cast<double>(most_rows)));
  elevation_step_ = static_cast<float>(rows > most_rows ? (high - low) / most_rows : height);
  image_.columns = columns;
  image_.margin = kMargin;
  image_.first_unseen_row = static_cast<int>(std::ceil(
      (sensor.elevation_max - low) / static_cast<double>(elevation_step_) - kRowRounding));
  grid_ = {1.0F / azimuth_step_, 1.0F / elevation_step_, static_cast<float>(low), columns};
}

void RangeImage::fill(const Scan& scan) {
  up_ = scan.T_world_sensor.linear().row(2).cast<float>();
  fill_bins(scan);
  for (int r = 0; r < image_.rows; ++r) {
    float* const bins = bins_.data() + bin(r, -kMargin);
    std::copy_n(bins + 2 * image_.columns, 2 * kMargin, bins);
    std::copy_n(bins + 2 * kMargin, 2 * kMargin, bins + 2 * (kMargin + image_.columns));
  }
  row_windows_.resize(bins_.size());
  windows_.resize(bins_.size());
  kernels_.fill_windows(image_, std::min(parameters_.window_columns, kMargin - 1),
                        std::min(parameters_.window_rows, image_.rows - 1), bins_.data(),
                        row_windows_.data(), windows_.data());
}

void RangeImage::fill_bins(const Scan& scan) {
  bins_.assign(bin(image_.rows, -kMargin), kInfinite);
  lowest_.assign(size(), kInfinite);
  const kernels::Sights sights = sight_room.room_for(scan.size()).sights;
  kernels_.locate(grid_,
                  in_sensor_frame(scan.points.empty() ? nullptr : scan.points.front().data(),
                                  scan.size(), Pose::Identity()),
                  sights);
  const auto nearest = static_cast<float>(parameters_.minimum_range);
  for (std::size_t k = 0; k < scan.size(); ++k) {
    const float range = sights.range[k];
    const int r = sights.row[k];
    if (range < nearest || r < 0 || r >= image_.rows) continue;
    float* const found = bins_.data() + bin(r, sights.column[k]);
    found[0] = std::min(found[0], range);
    found[1] = std::min(found[1], -range);
    float& lowest = lowest_[static_cast<std::size_t>(r * image_.columns + sights.column[k])];
    lowest = std::min(lowest, up_.dot(scan.points[k]) / range);
  }
}

Observation RangeImage::observe(const Eigen::Vector3f& place, SeenThrough seen) const {
  const kernels::Sights sights = sight_room.room_for(1).sights;
  kernels_.locate(grid_, in_sensor_frame(place.data(), 1, Pose::Identity()), sights);
  const float range = sights.range[0];
  const int column = sights.column[0], row = sights.row[0];
  Observation observation = observe_every_bin(range, column, row);
  if (is_met(observation) && is_asked_at_height(range, seen)) {
    observation = observe_at_height(place, range, column, row);
  }
  if (observation == Observation::kOccluded) {
    return sees_through_gap(place, seen, range, column, row) ? Observation::kFree : observation;
  }
  const bool may_pass_above = observation == Observation::kFree && seen == SeenThrough::kAtOrBelow;
  return may_pass_above && !sees_at_or_below(place, range, column, row, window_at(range))
             ? Observation::kUnknown
             : observation;
}

kernels::SightTest RangeImage::test() const {
  kernels::SightTest test;
  test.bins = bins_.data();
  test.windows = windows_.data();
  test.row_windows = row_windows_.data();
  test.wide = parameters_.window_columns;
  test.high = parameters_.window_rows;
  test.least_range = near_range();
  test.agree = agree_;
  test.occluded = occluded_;
  test.range_min = static_cast<float>(parameters_.evidence_range_min);
  test.range_max = static_cast<float>(parameters_.evidence_range_max);
  return test;
}

void RangeImage::observe(const std::vector<float>& places, const Pose& T_sensor_places,
                         SeenThrough seen, std::vector<ObservedPlace>& observed) const {
  const std::size_t count = places.size() / 3;
  const kernels::ChosenSights chosen = sight_room.room_for(count);
  const kernels::SightTest test = this->test();
  const std::size_t chosen_count = kernels_.choose(
      grid_, in_sensor_frame(places.data(), count, T_sensor_places), image_, test, chosen);
  std::size_t unsure_count = 0;
  for (std::size_t i = 0; i < chosen_count; ++i) {
    sight_room.unsure[unsure_count] = static_cast<std::uint32_t>(i);
    if (sighted_at(chosen, i) == kernels::Sighted::kUnsure) ++unsure_count;
  }
  kernels_.settle(image_, test, sight_room.unsure.data(), unsure_count, chosen);
  observed.clear();
  for (std::size_t i = 0; i < chosen_count; ++i) {
    const float range = chosen.sights.range[i];
    const int column = chosen.sights.column[i], row = chosen.sights.row[i];
    const auto in_sensor = [&]() -> Eigen::Vector3f {
      const Eigen::Map<const Eigen::Vector3f> place(places.data() + 3 * chosen.place[i]);
      return (T_sensor_places * place.cast<double>()).cast<float>();
    };
    Observation observation = observation_of(sighted_at(chosen, i), range, column, row);
    if (is_met(observation) && is_asked_at_height(range, seen)) {
      observation = observe_at_height(in_sensor(), range, column, row);
    }
    if (observation == Observation::kOccluded) {
      if (!may_be_gap(range, column, row)) continue;
      if (!sees_through_gap(in_sensor(), seen, range, column, row)) continue;
      observation = Observation::kFree;
    } else if (observation == Observation::kFree && seen == SeenThrough::kAtOrBelow) {
      if (!sees_at_or_below(in_sensor(), range, column, row, window_at(range))) continue;
    }
    if (observation == Observation::kUnknown) continue;
    observed.push_back({chosen.place[i], observation, range, column, row});
  }
}

Observation RangeImage::observation_of(kernels::Sighted sighted, float range, int column,
                                       int row) const {
  switch (sighted) {
    case kernels::Sighted::kAgree:
      return Observation::kAgree;
    case kernels::Sighted::kFree:
      return Observation::kFree;
    case kernels::Sighted::kOccluded:
      return Observation::kOccluded;
    case kernels::Sighted::kNothing:
      return Observation::kUnknown;
    case kernels::Sighted::kUnsure:
      break;
  }
  return observe_large_window(range, column, row);
}

RangeImage::Window RangeImage::window_at(float range) const {
  const float half = half_voxel_ / range;
  return {
      std::clamp(static_cast<int>(half / azimuth_step_), parameters_.window_columns, kMargin - 1),
      std::max(static_cast<int>(half / elevation_step_), parameters_.window_rows)};
}

RangeImage::Bounds RangeImage::bounds_at(float range) const {
  const float agree = agree_[0] + agree_[1] * range;
  const float beyond = range + occluded_[0] + occluded_[1] * range;
  return {range, agree, beyond, range - agree - kRangeRounding,
          std::max(range + agree, beyond) + kRangeRounding};
}

Observation RangeImage::observe_every_bin(float range, int column, int row) const {
  const auto [wide, high] = window_at(range);
  const Bounds bounds = bounds_at(range);
  bool occluded = false, below = false;
  for (int r = std::max(row - high, 0); r <= std::min(row + high, image_.rows - 1); ++r) {
    if (agrees_in_row(bounds, r, column, wide, occluded)) return Observation::kAgree;
    below |= r <= row && nearest_in_row(r, column, wide) < kInfinite;
  }
  if (occluded) return Observation::kOccluded;
  return below && row < image_.first_unseen_row ? Observation::kFree : Observation::kUnknown;
}

bool RangeImage::agrees_in_row(const Bounds& bounds, int row, int column, int wide,
                               bool& occluded) const {
  const float* const bins = bins_.data() + bin(row, column - wide);
  for (int c = 0; c <= 2 * wide; ++c) {
    const float nearest = bins[2 * c], farthest = -bins[2 * c + 1];
    if (std::abs(nearest - bounds.range) <= bounds.agree ||
        std::abs(farthest - bounds.range) <= bounds.agree) {
      return true;
    }
    occluded |= nearest < bounds.beyond;
  }
  return false;
}

float RangeImage::nearest_in_row(int row, int column, int wide) const {
  const float* const bins = bins_.data() + bin(row, column - wide);
  float nearest = kInfinite;
  for (int c = 0; c <= 2 * wide; ++c) nearest = std::min(nearest, bins[2 * c]);
  return nearest;
}

template <class Stops>
bool RangeImage::any_beam(int column, int row, const Window& window, Stops&& stops) const {
  for (int i = 0; i <= 2 * window.high; ++i) {
    const int r = row + from_the_middle(i);
    if (r < 0 || r >= image_.rows) continue;
    for (int k = 0; k <= 2 * window.wide; ++k) {
      if (stops(lowest_at(r, wrapped(column + from_the_middle(k))))) return true;
    }
  }
  return false;
}

RangeImage::Passing RangeImage::passing(const ObservedPlace& place, float low, float high) const {
  if (!has_even_beams_) return {true, -kInfinite, kInfinite};
  const float from = low / place.range, to = high / place.range;
  float below = -kInfinite, above = kInfinite;
  const bool between = any_beam(place.column, place.row, window_at(place.range), [&](float beam) {
    if (beam < from) {
      below = std::max(below, beam);
    } else if (beam > to) {
      above = std::min(above, beam);
    } else {
      return true;
    }
    return false;
  });
  return {between, below * place.range, above * place.range};
}

bool RangeImage::sees_at_or_below(const Eigen::Vector3f& place, float range, int column, int row,
                                  const Window& window) const {
  const float most = up_.dot(place) / range;
  return any_beam(column, row, window, [most](float beam) { return beam <= most; });
}

}  // namespace raymoval::raymoval_plus_method
