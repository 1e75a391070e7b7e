// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/scan/scan.h"
#include "methods/erasor/parameters.h"

namespace raymoval::erasor_method {

/// R-GPF (region-wise ground plane fitting): which of a bin's map points are ground. `points` are
/// in the body frame, metres. All of them if there is nothing to start from.
/// @return 1 = ground, 0 = above it
Mask find_ground(const std::vector<Eigen::Vector3d>& points, const Parameters& parameters);

}  // namespace raymoval::erasor_method
