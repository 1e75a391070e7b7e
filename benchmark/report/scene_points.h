// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "benchmark/report/report_points.h"
#include "benchmark/report/scene.h"

namespace raymoval {

/// The position of a point in steps, of which `kStepsPerVoxel` are an edge of a `kPageVoxel`. It
/// lies within the voxel of `voxel_index`, whatever rounding does.
/// @throws DataError beyond what 32 bits hold
std::array<std::int32_t, 3> steps_of(const Eigen::Vector3d& world);

/// Puts the points of both sets, and their verdicts, into `scene`, in an order in which neighbours
/// in space are near each other.
void gather_points(const ReportPoints& first, const ReportPoints& second, Scene& scene);

}  // namespace raymoval
