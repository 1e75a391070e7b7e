// SPDX-License-Identifier: MIT
// Step 3 for places that something nearer in their window hides: whether they are seen beside it.
#include <algorithm>
#include <cmath>

#include "methods/raymoval_plus/evidence/range_image.h"

namespace raymoval::raymoval_plus_method {
namespace {

/// A gap beside what is nearer must be as high as this many rows toward the horizon. Away from it,
/// it is as high as the window: below the horizon a surface is met nearer by lower beams, and above
/// by higher ones, so that one seen at a grazing angle is no gap.
constexpr int kGapRows = 1;
/// A return of the next beam is within so many rows, for rows are half a beam high.
constexpr int kNextBeamRows = 3;
/// Returns of three beams lie on one plane if their inverse ranges change from the first to the
/// second by this share, or more, of what they change from the second to the third, or vice versa.
constexpr float kLeastAlike = 1.0F / 3.0F;
/// A beam meets the middle of a place, or passes it lower, if it is at most so many metres above.
constexpr float kMiddle = 0.02F;

/// A point of the vertical plane of a column: its distance ahead of the sensor, and its height.
Eigen::Vector2f in_plane(float range, float sine) {
  return range * Eigen::Vector2f(std::sqrt(std::max(1.0F - sine * sine, 0.0F)), sine);
}

/// How far a point of a plane is above the line through two others.
float above_line(const Eigen::Vector2f& point, const Eigen::Vector2f& near,
                 const Eigen::Vector2f& far) {
  const Eigen::Vector2f along = (far - near).normalized(), from_near = point - near;
  return along.x() * from_near.y() - along.y() * from_near.x();
}

}  // namespace

bool RangeImage::may_be_gap(float range, int column, int row) const {
  return parameters_.gaps && row >= 0 && row < image_.first_unseen_row && row < image_.rows &&
         bins_[bin(row, column)] >= bounds_at(range).beyond;
}

bool RangeImage::goes_on_beyond(const Eigen::Vector3f& place, float range, int column,
                                int row) const {
  if (row < 0 || row >= image_.rows) return false;
  // Where beams are dense, those beside the middle of a place meet it, too, and have a say.
  if (2.0F * half_voxel_ > elevation_step_ * range) return false;
  const float sine = up_.dot(place) / range, beam = lowest_at(row, column);
  if (sine >= 0.0F || beam > sine + kMiddle / range) return false;
  const float passes = bins_[bin(row, column)];
  if (passes < beyond_gap(range)) return false;
  const Return below = next_return(row - 1, -1, column, 0);
  return below.range >= range ||
         above_line(in_plane(range, sine), in_plane(below.range, lowest_at(below.row, column)),
                    in_plane(passes, beam)) > half_voxel_;
}

bool RangeImage::sees_through_gap(const Eigen::Vector3f& place, SeenThrough seen, float range,
                                  int column, int row) const {
  if (!parameters_.gaps || row >= image_.first_unseen_row) return false;
  if (goes_on_beyond(place, range, column, row)) return true;
  const Window window = window_at(range);
  const int wide = window.wide - parameters_.window_columns;
  const int toward = window.high - parameters_.window_rows + kGapRows;
  const bool is_up = up_.dot(place) > 0.0F;
  const int low = std::max(row - (is_up ? toward : window.high), 0);
  const int high = std::min(row + (is_up ? window.high : toward), image_.rows - 1);
  const float beyond = beyond_gap(range);
  bool below = false;
  for (int r = low; r <= high; ++r) {
    const float nearest = nearest_in_row(r, column, wide);
    if (nearest < beyond) return false;
    below |= r <= row && nearest < kInfinite;
  }
  if (!below || is_on_slope(range, column, row, wide, is_up ? -1 : 1)) return false;
  return seen == SeenThrough::kInRowOrBelow ||
         sees_at_or_below(place, range, column, row, {wide, window.high});
}

RangeImage::Return RangeImage::next_return(int row, int step, int column, int wide) const {
  for (int n = 0; n < kNextBeamRows; ++n, row += step) {
    if (row < 0 || row >= image_.rows) break;
    const float nearest = nearest_in_row(row, column, wide);
    if (nearest < kInfinite) return {row, nearest};
  }
  return {row, kInfinite};
}

bool RangeImage::is_on_slope(float range, int column, int row, int wide, int toward) const {
  const float beyond = bounds_at(range).beyond;
  // The return that passes the place, and the next one toward the horizon, which hides it.
  Return passes{row, kInfinite}, hides = next_return(row, toward, column, wide);
  while (hides.range >= beyond && hides.range < kInfinite) {
    passes = hides;
    hides = next_return(hides.row + toward, toward, column, wide);
  }
  if (hides.range == kInfinite || std::abs(hides.row - row) > kNextBeamRows) return false;
  if (passes.range == kInfinite) passes = next_return(row - toward, -toward, column, wide);
  if (passes.range == kInfinite) return false;
  // By how much the inverse range of a plane through two returns falls in a row.
  const auto fall = [](const Return& near, const Return& far) {
    return (1.0F / near.range - 1.0F / far.range) /
           static_cast<float>(std::abs(near.row - far.row));
  };
  const float slope = fall(hides, passes);
  // On the plane the place would be seen so many rows from the return that passes it.
  const float rows = (1.0F / range - 1.0F / passes.range) / slope;
  if (rows > static_cast<float>((row - passes.row) * toward) + 1.0F) return false;
  const auto goes_on = [&](const Return& near, const Return& far) {
    if (near.range == kInfinite || far.range == kInfinite) return false;
    const float other = fall(near, far);
    return std::min(slope, other) >= kLeastAlike * std::max(slope, other);
  };
  return goes_on(passes, next_return(passes.row - toward, -toward, column, wide)) ||
         goes_on(next_return(hides.row + toward, toward, column, wide), hides);
}

}  // namespace raymoval::raymoval_plus_method
