// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/scan/directions.h"

namespace raymoval {

/// The pattern of a sensor's directions.
struct DirectionPattern {
  enum class Kind {
    kUnknown,    ///< Too few directions.
    kColumns,    ///< Beams of even steps in azimuth; columns of different beams may be shifted.
    kBeams,      ///< Beams, but no even steps, such as several unaligned revolutions.
    kScattered,  ///< Neither, such as non-repetitive LiDARs and downsampled scans.
  };
  Kind kind = Kind::kUnknown;
  /// Radians. Scattered directions have the same step both ways: the edge of the square that each
  /// of them has to itself in one scan. 0 = unknown.
  double azimuth_step = 0.0;
  double elevation_step = 0.0;  ///< Mean between neighbouring beams.
  int beams = 0;                ///< 0 if there are none.
};

/// Finds the pattern that `scans` (of one sensor) share.
///
/// Columns: the least step in azimuth at which nearly every direction has a partner on its own
/// beam, while there are few partners between the steps. Two revolutions in a scan show the step of
/// one. Beams: from the lowest elevation up, each beam lies above the last by the usual distance
/// to the next direction above in the same column. This finds uneven beams, and beams that are no
/// sharp lines in elevation (an HDL-64E's lasers are not in one place).
///
/// The result does not depend on the order of points. Memory and time, beyond the list of
/// directions, are bounded.
/// @param elevation_low, elevation_high field of view, radians
DirectionPattern find_direction_pattern(const std::vector<Directions>& scans, double elevation_low,
                                        double elevation_high);

}  // namespace raymoval
