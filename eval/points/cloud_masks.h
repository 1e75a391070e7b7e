// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/scan/mask_store.h"
#include "eval/protocol.h"

namespace raymoval {

/// Distance in metres within which a point of a scan is found again in a cleaned cloud: that of the
/// KTH DynamicMap benchmark.
inline constexpr double kCloudDistance = 0.05;

/// What a cleaned cloud says of each point of the scans: removed if no point of the cloud is at
/// `distance` metres or less (the export step of the KTH DynamicMap benchmark).
/// @param cloud finite points in the world frame, in any order; empty: everything is removed
/// @note A point that was removed but lies that near to a kept one passes for kept, and a cloud
///   thinned to voxels of more than twice the distance passes for one with most points removed.
MaskStore masks_of_cloud(const EvaluationInput& input, const std::vector<Eigen::Vector3f>& cloud,
                         double distance);

/// A cleaned cloud, and the masks that follow from it once somebody has asked for them. Not for
/// several threads at once.
class CloudEstimate {
 public:
  /// @param points finite, in the world frame; must outlive this object
  explicit CloudEstimate(const std::vector<Eigen::Vector3f>& points) : points_(points) {}

  [[nodiscard]] const std::vector<Eigen::Vector3f>& points() const { return points_; }
  /// `masks_of_cloud`; computed again only for another distance.
  /// @param input the same in each call
  const MaskStore& masks(const EvaluationInput& input, double distance) const;

 private:
  const std::vector<Eigen::Vector3f>& points_;
  mutable std::optional<double> distance_;
  mutable MaskStore masks_;
};

}  // namespace raymoval
