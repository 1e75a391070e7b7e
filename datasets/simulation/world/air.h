// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

namespace raymoval::simulated {

/// What light goes through besides empty space.
struct Air {
  /// Share of shots that a pane lets through, so that they go on to what stands behind it.
  double glass_through = 0.0;
  /// Distance in metres at which 5 % of light is left (the meteorological optical range;
  /// Koschmieder 1924): rain, fog or dust take the rest, on the way there and on the way back.
  double visibility_m = std::numeric_limits<double>::infinity();
  /// Share of shots that meet a drop or a flake which sends back enough light to be taken for a
  /// surface, if nothing solid comes before it. Such points are outliers (label 1).
  double echo_share = 0.0;
  /// Mean distance of these drops in metres; they are dense near the sensor and thin out
  /// exponentially, since only near ones are bright enough.
  double echo_range_m = 6.0;
};

}  // namespace raymoval::simulated
