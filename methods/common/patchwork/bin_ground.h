// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "methods/common/patchwork/parameters.h"
#include "methods/common/plane_fit.h"

namespace raymoval::patchwork {

/// What a bin lies like: in the innermost zone there may be mirrored points below the ground, and
/// walls next to the sensor.
struct BinSurroundings {
  bool is_innermost = false;
  double sensor_height = 0.0;  ///< Metres above the ground; infinite where it is unknown.
};

/// R-VPF and R-GPF (region-wise fits of vertical and of ground planes): finds the plane that a bin
/// begins with from below, after walls are taken out in the innermost zone.
/// @param points level frame with the sensor at the origin, metres; at least one
/// @param ground as long as the points; becomes 1 for the points near the plane or below it
/// @return the plane through those points, or nothing where all points belong to walls
std::optional<PlaneFit> find_bin_ground(std::span<const Eigen::Vector3d> points,
                                        const BinSurroundings& surroundings,
                                        const GroundParameters& parameters,
                                        std::span<std::uint8_t> ground);

}  // namespace raymoval::patchwork
