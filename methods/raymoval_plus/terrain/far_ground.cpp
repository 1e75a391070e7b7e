// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/terrain/far_ground.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "methods/raymoval_plus/terrain/tiles.h"

namespace raymoval::raymoval_plus_method {
namespace {

/// Lowers heights to what those a step away, to either side and obliquely, allow: those at least
/// `margin` columns inside of the square.
void lower_by_step(int step, int margin, const std::vector<float>& rises, int side,
                   std::vector<float>& heights) {
  const std::vector<float> before = heights;
  for (int n = 0; n < 9; ++n) {
    const int dx = (n % 3 - 1) * step, dy = (n / 3 - 1) * step;
    if (dx == 0 && dy == 0) continue;
    const float distance = static_cast<float>(step) * (dx != 0 && dy != 0 ? std::sqrt(2.0F) : 1.0F);
    for (int y = margin; y < side - margin; ++y) {
      const float* const from = before.data() + (y + dy) * side + dx;
      const float* const rise = rises.data() + y * side;
      float* const to = heights.data() + y * side;
      for (int x = margin; x < side - margin; ++x) {
        to[x] = std::min(to[x], from[x] + distance * rise[x]);
      }
    }
  }
}

}  // namespace

std::vector<float> highest_rises(const std::vector<float>& rise_x, const std::vector<float>& rise_y,
                                 double cell, double slope) {
  std::vector<float> rises(rise_x.size());
  for (std::size_t i = 0; i < rises.size(); ++i) {
    rises[i] =
        static_cast<float>(slope * cell) + std::sqrt(rise_x[i] * rise_x[i] + rise_y[i] * rise_y[i]);
  }
  return rises;
}

std::vector<float> bounded_from_afar(const std::vector<float>& ground,
                                     const std::vector<float>& rises, int side) {
  std::vector<float> lowest = ground;
  int margin = 0;
  for (const int step : kFarSteps) lower_by_step(step, margin += step, rises, side, lowest);
  for (std::size_t i = 0; i < lowest.size(); ++i) {
    if (!(ground[i] < kNoGround)) lowest[i] = kNoGround;
  }
  return middle_of(lowest, side, kFarReach);
}

}  // namespace raymoval::raymoval_plus_method
