// SPDX-License-Identifier: MIT
#pragma once

namespace raymoval {

/// The handling of points that are measured while the sensor moves.
enum class Rolling {
  kNone,       ///< A whole scan is taken in one instant.
  kSkewed,     ///< Each point is in the sensor frame at its own time.
  kCorrected,  ///< Each point is in the sensor frame at the scan's reference time.
};

/// As users write them, in the order of the values.
inline constexpr const char* kRollingNames[] = {"none", "skewed", "corrected"};

}  // namespace raymoval
