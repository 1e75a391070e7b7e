// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/scan/voxel_key.h"

namespace raymoval {

/// Points thinned to one centroid per voxel, in the order of the voxels' first points.
class ThinnedPoints {
 public:
  /// @param voxel edge of a voxel, metres; the lattice is in the frame of the points
  explicit ThinnedPoints(double voxel) : inverse_(1.0 / voxel) {}

  /// Adds a point. @return the number of its centroid
  std::size_t add(const Eigen::Vector3d& point) {
    const auto [found, is_new] =
        numbers_.try_emplace(voxel_key(voxel_index(point, inverse_)), sums_.size());
    if (is_new) {
      sums_.emplace_back(Eigen::Vector3d::Zero());
      counts_.push_back(0.0);
    }
    sums_[found->second] += point;
    counts_[found->second] += 1.0;
    return found->second;
  }
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  /// The number of the centroid of a point's voxel; `kNone` if the voxel has no point.
  [[nodiscard]] std::size_t find(const Eigen::Vector3d& point) const {
    const auto found = numbers_.find(voxel_key(voxel_index(point, inverse_)));
    return found == numbers_.end() ? kNone : found->second;
  }
  [[nodiscard]] std::size_t size() const { return sums_.size(); }
  [[nodiscard]] Eigen::Vector3d centroid(std::size_t i) const { return sums_[i] / counts_[i]; }

 private:
  double inverse_;
  VoxelMap<std::size_t> numbers_;
  std::vector<Eigen::Vector3d> sums_;
  std::vector<double> counts_;
};

}  // namespace raymoval
