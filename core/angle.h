// SPDX-License-Identifier: MIT
#pragma once

#include <numbers>

namespace raymoval {

/// Radians of a degree.
inline constexpr double kDegree = std::numbers::pi / 180.0;
/// Radians of a full turn.
inline constexpr double kTurn = 2.0 * std::numbers::pi;

}  // namespace raymoval
