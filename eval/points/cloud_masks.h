// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/scan/mask_store.h"
#include "eval/protocol.h"

namespace raymoval {

/// Largest distance, in metres, at which a point of a scan counts as found in a cleaned cloud. The
/// KTH DynamicMap benchmark uses this distance.
inline constexpr double kCloudDistance = 0.05;

/// The masks that follow from a cleaned cloud: a point of a scan is removed if no point of the
/// cloud is at `distance` metres or less (the export step of the KTH DynamicMap benchmark).
/// @param cloud finite points in the world frame, in any order; if it is empty, every point is
///   removed
/// @note A removed point that lies within the distance of a kept one counts as kept. If a cloud was
///   thinned to voxels of more than twice the distance, most points count as removed.
MaskStore masks_of_cloud(const EvaluationInput& input, const std::vector<Eigen::Vector3f>& cloud,
                         double distance);

/// A cleaned cloud, and the masks that follow from it, which are computed at first use.
/// @note Only one thread at a time may use it.
class CloudEstimate {
 public:
  /// @param points finite, in the world frame; must outlive this object
  explicit CloudEstimate(const std::vector<Eigen::Vector3f>& points) : points_(points) {}

  [[nodiscard]] const std::vector<Eigen::Vector3f>& points() const { return points_; }
  /// See `masks_of_cloud`. The masks are computed again only for another distance.
  /// @param input the same in each call
  const MaskStore& masks(const EvaluationInput& input, double distance) const;

 private:
  const std::vector<Eigen::Vector3f>& points_;
  mutable std::optional<double> distance_;
  mutable MaskStore masks_;
};

}  // namespace raymoval
