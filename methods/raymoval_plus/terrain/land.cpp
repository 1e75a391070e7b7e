// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/terrain/land.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "methods/raymoval_plus/terrain/tiles.h"

namespace raymoval::raymoval_plus_method {
namespace {

/// What rises by no more than so much a metre counts as level.
constexpr double kLevelSlope = 0.1;
/// What differs by more metres is no slope, but an edge: of a roof, a wall, the crown of a tree.
constexpr float kMostDifference = 1.0F;
/// With fewer differences along an axis the land is taken for level by as much as are missing.
constexpr std::int64_t kEnoughDifferences = 25;
/// Whole numbers have the same sum in any order, so that quarter turns change nothing.
constexpr float kParts = 4096.0F;

/// Sums over rectangles of a square of columns.
class Sums {
 public:
  explicit Sums(int side)
      : stride_(static_cast<std::size_t>(side) + 1), values_(stride_ * stride_, 0) {}
  /// To be called row by row. @param value of the column (x, y)
  void set(int x, int y, std::int64_t value) {
    const std::size_t here = at(x + 1, y + 1);
    values_[here] =
        value + values_[here - 1] + values_[here - stride_] - values_[here - stride_ - 1];
  }
  /// The sum over columns from (left, bottom) to before (right, top).
  [[nodiscard]] std::int64_t over(int left, int bottom, int right, int top) const {
    return values_[at(right, top)] - values_[at(left, top)] - values_[at(right, bottom)] +
           values_[at(left, bottom)];
  }

 private:
  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * stride_ + static_cast<std::size_t>(x);
  }
  std::size_t stride_;
  std::vector<std::int64_t> values_;
};

/// How much the land rises along an axis, around each column.
class Rises {
 public:
  Rises(const std::vector<float>& ground, int side, int axis)
      : side_(side), sums_(side), counts_(side) {
    const int lag_x = axis == 0 ? kHalfLag : 0, lag_y = kHalfLag - lag_x;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const bool is_inside = x >= lag_x && y >= lag_y && x + lag_x < side && y + lag_y < side;
        float rise = kNoGround;
        if (is_inside) {
          rise = ground[static_cast<std::size_t>((y + lag_y) * side + x + lag_x)] -
                 ground[static_cast<std::size_t>((y - lag_y) * side + x - lag_x)];
        }
        const bool is_known = std::isfinite(rise) && std::abs(rise) <= kMostDifference;
        sums_.set(x, y, is_known ? std::lround(rise * kParts) : 0);
        counts_.set(x, y, is_known ? 1 : 0);
      }
    }
  }
  /// The mean rise over `2 kHalfLag` columns around a column, metres.
  [[nodiscard]] float around(int x, int y) const {
    const int left = std::max(x - kLandReach, 0), right = std::min(x + kLandReach + 1, side_);
    const int bottom = std::max(y - kLandReach, 0), top = std::min(y + kLandReach + 1, side_);
    const std::int64_t count = std::max(counts_.over(left, bottom, right, top), kEnoughDifferences);
    return static_cast<float>(sums_.over(left, bottom, right, top)) /
           (kParts * static_cast<float>(count));
  }

 private:
  int side_;
  Sums sums_, counts_;
};

}  // namespace

std::vector<float> land_rise(const std::vector<float>& ground, int side, int axis) {
  const Rises rises(ground, side, axis);
  std::vector<float> found(ground.size());
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      found[static_cast<std::size_t>(y * side + x)] = rises.around(x, y) / (2.0F * kHalfLag);
    }
  }
  return found;
}

GroundPlane steep_part(float rise_x, float rise_y, double cell) {
  const float rise = std::sqrt(rise_x * rise_x + rise_y * rise_y);
  const auto level = static_cast<float>(kLevelSlope * cell);
  if (rise <= level) return {0.0F};
  const float share = 1.0F - level / rise;
  return {0.0F, share * rise_x, share * rise_y};
}

float quantile_below_middle(const GroundPlane& plane, double quantile) {
  const float a = 0.5F * std::max(std::abs(plane.rise_x), std::abs(plane.rise_y));
  const float b = 0.5F * std::min(std::abs(plane.rise_x), std::abs(plane.rise_y));
  const auto share = static_cast<float>(quantile);
  // Heights are between -(a + b) and a + b. Their density rises up to b - a, and is 1 / 2a beyond.
  if (b <= 2.0F * a * share) return a - 2.0F * a * share;
  return a + b - std::sqrt(8.0F * a * b * share);
}

}  // namespace raymoval::raymoval_plus_method
