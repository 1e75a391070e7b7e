// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace raymoval {

/// A number from 0 to 4 that grows with the azimuth of (x, y) by 1 per quarter turn. It replaces an
/// arc tangent where only the order of directions matters.
inline double diamond_angle(double x, double y) {
  const double sum = std::abs(x) + std::abs(y);
  if (sum == 0.0) return 0.0;
  const double slope = y / sum;
  if (x < 0.0) return 2.0 - slope;
  return slope < 0.0 ? 4.0 + slope : slope;
}

}  // namespace raymoval
