// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace raymoval::raymoval_plus_method {

/// Which beams see through a place that no return agrees with and none hides.
enum class SeenThrough : std::uint8_t {
  /// Those in the place's row of bins or below. A row is half a beam high, so that some pass a
  /// little above it. Few places have more than one beam, and what stands has its neighbours' vote.
  kInRowOrBelow,
  /// Those that do not pass above the place (in the world, whichever way the sensor is turned). Far
  /// away the beam above a place on the ground goes on to a wall, and the one below may be lost.
  kAtOrBelow,
};

}  // namespace raymoval::raymoval_plus_method
