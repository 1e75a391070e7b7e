// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>

#include "core/scan/scan_spool.h"

namespace raymoval {

/// A confidence is kept as a whole number of these steps from 0 to 1, in a byte.
inline constexpr int kConfidenceSteps = 250;

/// The number of steps of a confidence from 0 to 1.
inline std::uint8_t confidence_steps(float confidence) {
  return static_cast<std::uint8_t>(std::lround(confidence * static_cast<float>(kConfidenceSteps)));
}
/// The confidence of a number of steps.
inline float confidence_of_steps(std::uint8_t steps) {
  return static_cast<float>(steps) / static_cast<float>(kConfidenceSteps);
}

/// The confidence of a method that each point moves: steps by scan, a byte per point.
struct ConfidenceStore {
  ScanSpool steps;  ///< Of no scan if confidence was not requested or the method has none.

  [[nodiscard]] bool empty() const { return steps.size() == 0; }
};

}  // namespace raymoval
