// SPDX-License-Identifier: MIT
#pragma once

namespace raymoval {

/// 3-D distances from the sensor in metres, both ends included. Points outside are not evaluated;
/// methods still get them.
struct RangeLimits {
  double min = 0.0;
  double max = 1e300;
  [[nodiscard]] bool contains(double range) const { return range >= min && range <= max; }
};

}  // namespace raymoval
