// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/mask_store.h"
#include "eval/protocol.h"

namespace raymoval {

/// Distance in metres within which a point of a scan is found again in a cleaned cloud: that of the
/// KTH DynamicMap benchmark.
inline constexpr double kCloudDistance = 0.05;

/// What a cleaned cloud says of each point of the scans: removed if no point of the cloud is at
/// `distance` metres or less (the export step of the KTH DynamicMap benchmark).
/// @param cloud finite points in the world frame, in any order; empty: everything is removed
/// @throws DataError if a point lies beyond the lattice
/// @note A point that was removed but lies that near to a kept one passes for kept, and a cloud
///   thinned to voxels of more than twice the distance passes for one with most points removed.
MaskStore masks_of_cloud(const EvaluationInput& input, const std::vector<Eigen::Vector3f>& cloud,
                         double distance);

}  // namespace raymoval
