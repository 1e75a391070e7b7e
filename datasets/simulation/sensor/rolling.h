// SPDX-License-Identifier: MIT
#pragma once

namespace raymoval {

/// What happens to points taken while the sensor moves.
enum class Rolling {
  kNone,       ///< A whole scan is taken in one instant.
  kSkewed,     ///< Each point is in the frame the sensor had when it was taken.
  kCorrected,  ///< Each point is brought into the frame of the scan's reference time.
};

/// As users write them, in the order of the values.
inline constexpr const char* kRollingNames[] = {"none", "skewed", "corrected"};

}  // namespace raymoval
