// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <limits>

#include "core/scan/voxel_key.h"

namespace raymoval::dufomap_method {

/// Walks a line from voxel to voxel (Amanatides and Woo 1987). Lengths in voxels.
class CellWalk {
 public:
  /// @param direction of unit length, or zero: then there is no next voxel
  /// @param cell a voxel on the line, at which the walk starts
  CellWalk(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, const VoxelIndex& cell)
      : cell_(cell) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      if (direction[k] == 0.0) continue;
      step_[axis] = direction[k] > 0.0 ? 1 : -1;
      next_[axis] = (cell[k] + (direction[k] > 0.0 ? 1 : 0) - origin[k]) / direction[k];
      delta_[axis] = 1.0 / std::abs(direction[k]);
    }
  }

  [[nodiscard]] const VoxelIndex& cell() const { return cell_; }
  /// Distance from the origin at which the line enters the next voxel.
  [[nodiscard]] double next_distance() const { return next_[next_axis()]; }
  /// Goes to the next voxel. @return the axis along which it lies
  std::size_t advance() {
    const std::size_t axis = next_axis();
    cell_[static_cast<Eigen::Index>(axis)] += step_[axis];
    next_[axis] += delta_[axis];
    return axis;
  }

 private:
  /// Through an edge: x before y before z.
  [[nodiscard]] std::size_t next_axis() const {
    const std::size_t level = next_[1] < next_[0] ? 1 : 0;
    return next_[2] < next_[level] ? 2 : level;
  }

  static constexpr double kNever = std::numeric_limits<double>::infinity();
  VoxelIndex cell_;
  std::array<int, 3> step_{};
  std::array<double, 3> next_{kNever, kNever, kNever}, delta_{kNever, kNever, kNever};
};

}  // namespace raymoval::dufomap_method
