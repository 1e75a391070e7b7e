// SPDX-License-Identifier: MIT
// Step 3 for places so near that their window is larger than the least one.
#include <algorithm>
#include <cmath>

#include "methods/raymoval_plus/evidence/range_image.h"

namespace raymoval::raymoval_plus_method {
namespace {

/// Windows grow with nearness. Where they start to, roundings may go either way, so that places a
/// little farther are looked at, too.
constexpr float kWindowsGrow = 1.001F;
/// A return is at the height of a place if it is at most so many metres, or so many rows, higher or
/// lower: three quarters of a beam, for rows are half a beam high.
constexpr float kSameHeight = 0.07F, kSameHeightRows = 1.5F;

}  // namespace

bool has_even_beams(const SensorModel& sensor) {
  if (sensor.has_beams()) return true;
  return !sensor.is_estimated() && sensor.elevation_step > 0.0 &&
         sensor.elevation_step != sensor.azimuth_step;
}

float RangeImage::near_range() const {
  return kWindowsGrow * half_voxel_ /
         std::min(azimuth_step_ * static_cast<float>(parameters_.window_columns + 1),
                  elevation_step_ * static_cast<float>(parameters_.window_rows + 1));
}

Observation RangeImage::observe_large_window(float range, int column, int row) const {
  const auto [wide, high] = window_at(range);
  const int low = std::max(row - high, 0), top = std::min(row + high, image_.rows - 1);
  const int least_wide = parameters_.window_columns, least_high = parameters_.window_rows;
  if (top - low < 2 * least_high) return observe_every_bin(range, column, row);
  const Bounds bounds = bounds_at(range);
  bool occluded = false;
  // Least windows cover the large one. Those at its upper and right ends may lie over others.
  for (int begin = low; begin <= top; begin += 2 * least_high + 1) {
    const int r = std::min(begin, top - 2 * least_high) + least_high;
    for (int left = -wide; left <= wide; left += 2 * least_wide + 1) {
      const int c = column + std::min(left, wide - 2 * least_wide) + least_wide;
      if (agrees_in_window(bounds, r, c, occluded)) return Observation::kAgree;
    }
  }
  if (occluded) return Observation::kOccluded;
  if (row >= image_.first_unseen_row) return Observation::kUnknown;
  for (int r = std::min(row, top); r >= low; --r) {
    if (nearest_in_row(r, column, wide) < kInfinite) return Observation::kFree;
  }
  return Observation::kUnknown;
}

bool RangeImage::agrees_in_window(const Bounds& bounds, int row, int column, bool& occluded) const {
  const int own = wrapped(column);
  const float* const window = windows_.data() + bin(row, own);
  // The minus says more than is asked here. Without a return both are +infinity.
  const float nearest = window[0], farthest = std::abs(window[1]);
  if (nearest == kInfinite) return false;
  if (farthest < bounds.from || nearest > bounds.to) {
    occluded |= nearest < bounds.beyond;
    return false;
  }
  for (int r = row - parameters_.window_rows; r <= row + parameters_.window_rows; ++r) {
    if (agrees_in_row(bounds, r, own, parameters_.window_columns, occluded)) return true;
  }
  return false;
}

Observation RangeImage::observe_at_height(const Eigen::Vector3f& place, float range, int column,
                                          int row) const {
  const auto [wide, high] = window_at(range);
  const Bounds bounds = bounds_at(range);
  const float height = up_.dot(place);
  const float reach = std::max(kSameHeight, kSameHeightRows * elevation_step_ * range);
  const auto is_at_height = [&](float at, int r, int c) {
    return std::abs(at * lowest_at(r, wrapped(c)) - height) <= reach;
  };
  const auto agrees = [&](float at, int r, int c) {
    return std::abs(at - range) <= bounds.agree && is_at_height(at, r, c);
  };
  const auto agrees_in_bin = [&](int r, int c) {
    const float* const returns = bins_.data() + bin(r, c);
    return agrees(returns[0], r, c) || agrees(-returns[1], r, c);
  };
  const int low = std::max(row - high, 0), top = std::min(row + high, image_.rows - 1);
  // Most places that a scan agrees with are met in their own bin.
  if (low <= row && row <= top && agrees_in_bin(row, column)) return Observation::kAgree;
  bool occluded = false, below = false;
  for (int r = low; r <= top; ++r) {
    for (int c = column - wide; c <= column + wide; ++c) {
      const float nearest = bins_[bin(r, c)];
      if (nearest == kInfinite) continue;
      if (agrees_in_bin(r, c)) return Observation::kAgree;
      if (nearest < range - bounds.agree) {
        occluded = true;
      } else if (nearest < bounds.beyond) {
        occluded |= is_at_height(nearest, r, c);
      } else {
        below |= r <= row && is_at_height(range, r, c);
      }
    }
  }
  if (occluded) return Observation::kOccluded;
  return below && row < image_.first_unseen_row ? Observation::kFree : Observation::kUnknown;
}

}  // namespace raymoval::raymoval_plus_method
