// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <numbers>

namespace raymoval {

// Angles in single precision, without branches, so that a compiler can compute several at a time
// (in a file compiled without errno and trap handling of the square root, see CMakeLists.txt).

/// Arc tangent of 0 <= t <= 1 in radians, with an error of at most 2e-8 before rounding (Abramowitz
/// and Stegun, 4.4.49).
inline float single_arc_tangent(float t) {
  const float s = t * t;
  float sum = 0.0028662257F;
  sum = sum * s - 0.0161657367F;
  sum = sum * s + 0.0429096138F;
  sum = sum * s - 0.0752896400F;
  sum = sum * s + 0.1065626393F;
  sum = sum * s - 0.1420889944F;
  sum = sum * s + 0.1999355085F;
  sum = sum * s - 0.3333314528F;
  return t + t * s * sum;
}

/// Angle of (a, b) for a, b >= 0, from the axis of a towards that of b, radians.
inline float single_angle_in_quadrant(float a, float b) {
  const float larger = a > b ? a : b, smaller = a > b ? b : a;
  const float angle = single_arc_tangent(smaller / (larger + 1e-30F));
  return a > b ? angle : static_cast<float>(std::numbers::pi / 2.0) - angle;
}

/// Azimuth of (x, y), -pi to pi.
inline float single_azimuth(float x, float y) {
  constexpr float kPi = static_cast<float>(std::numbers::pi);
  const float quadrant = single_angle_in_quadrant(std::abs(x), std::abs(y));
  const float half = x < 0.0F ? kPi - quadrant : quadrant;
  return y < 0.0F ? -half : half;
}

/// Elevation of a point at a horizontal distance and a height, -pi/2 to pi/2.
inline float single_elevation(float distance, float z) {
  const float steep = single_angle_in_quadrant(distance, std::abs(z));
  return z < 0.0F ? -steep : steep;
}

}  // namespace raymoval
