// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/terrain/far_ground.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "methods/raymoval_plus/terrain/tiles.h"

namespace raymoval::raymoval_plus_method {
namespace {

/// A difference counts as this at most, metres: crowns of trees are far above the land.
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
  /// @param dx 1 for the rise along x, 0 for that along y
  Rises(const std::vector<float>& ground, int side, int dx)
      : side_(side), sums_(side), counts_(side) {
    const int lag_x = dx * kHalfLag, lag_y = (1 - dx) * kHalfLag;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const bool is_inside = x >= lag_x && y >= lag_y && x + lag_x < side && y + lag_y < side;
        float rise = kNoGround;
        if (is_inside) {
          rise = ground[static_cast<std::size_t>((y + lag_y) * side + x + lag_x)] -
                 ground[static_cast<std::size_t>((y - lag_y) * side + x - lag_x)];
        }
        const bool is_known = std::isfinite(rise);
        const float bounded = is_known ? std::clamp(rise, -kMostDifference, kMostDifference) : 0.0F;
        sums_.set(x, y, std::lround(bounded * kParts));
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

/// Lowers heights to what those a step away, to either side and obliquely, allow.
void lower_by_step(int step, const std::vector<float>& rises, int side,
                   std::vector<float>& heights) {
  const std::vector<float> before = heights;
  for (int n = 0; n < 9; ++n) {
    const int dx = (n % 3 - 1) * step, dy = (n / 3 - 1) * step;
    if (dx == 0 && dy == 0) continue;
    const float distance = static_cast<float>(step) * (dx != 0 && dy != 0 ? std::sqrt(2.0F) : 1.0F);
    const int left = std::max(0, -dx), right = side - std::max(0, dx);
    for (int y = std::max(0, -dy); y < side - std::max(0, dy); ++y) {
      const float* const from = before.data() + (y + dy) * side + dx;
      const float* const rise = rises.data() + y * side;
      float* const to = heights.data() + y * side;
      for (int x = left; x < right; ++x) to[x] = std::min(to[x], from[x] + distance * rise[x]);
    }
  }
}

}  // namespace

std::vector<float> highest_rises(const std::vector<float>& ground, int side, double cell,
                                 double slope) {
  const Rises along_x(ground, side, 1), along_y(ground, side, 0);
  std::vector<float> rises(ground.size());
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const float rise_x = along_x.around(x, y), rise_y = along_y.around(x, y);
      rises[static_cast<std::size_t>(y * side + x)] =
          static_cast<float>(slope * cell) +
          std::sqrt(rise_x * rise_x + rise_y * rise_y) / (2.0F * kHalfLag);
    }
  }
  return rises;
}

std::vector<float> bounded_from_afar(const std::vector<float>& ground,
                                     const std::vector<float>& rises, int side) {
  std::vector<float> lowest = ground;
  for (const int step : kFarSteps) lower_by_step(step, rises, side, lowest);
  for (std::size_t i = 0; i < lowest.size(); ++i) {
    if (!(ground[i] < kNoGround)) lowest[i] = kNoGround;
  }
  return lowest;
}

}  // namespace raymoval::raymoval_plus_method
