// SPDX-License-Identifier: MIT
#pragma once

#include <numbers>

namespace raymoval {

/// Radians of a degree.
inline constexpr double kDegree = std::numbers::pi / 180.0;

}  // namespace raymoval
