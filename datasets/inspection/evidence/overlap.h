// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "core/scan/scan.h"
#include "core/scan/sensor_model.h"

namespace raymoval::inspection {

/// The azimuths that a scan of more than one revolution passes twice, counter-clockwise.
struct Overlap {
  double from = 0.0;   ///< Radians, -pi to pi.
  double width = 0.0;  ///< Radians.

  [[nodiscard]] double to() const { return from + width; }
};

/// Where most points of `scan` have another one in about the same direction, and few have
/// elsewhere; to 5 degrees. None below 15 degrees, and none for a sensor without beams. Both
/// returns of a pulse give no overlap, for they lie all around.
/// @param seen the sensor as its scans show it
std::optional<Overlap> find_overlap(const Scan& scan, const SensorModel& seen);

}  // namespace raymoval::inspection
