// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "core/scan/voxel_key.h"
#include "eval/lattice/cell_lattice.h"

namespace raymoval {

/// Squared distances from a point to the layers of cells below its own, of its own and above, along
/// each axis. A millionth of a metre is taken off, so that rounding excludes no cell.
class LayerGaps {
 public:
  /// @param index of the cell that the point is in, or by rounding beside
  LayerGaps(const Eigen::Vector3d& point, const VoxelIndex& index, double size) {
    constexpr double kMargin = 1e-6;
    for (int axis = 0; axis < 3; ++axis) {
      const double below = std::max(0.0, point[axis] - index[axis] * size - kMargin);
      const double above = std::max(0.0, (index[axis] + 1) * size - point[axis] - kMargin);
      squared_(axis, 0) = below * below;
      squared_(axis, 2) = above * above;
    }
  }
  /// Squared distance to the cell at an offset of -1 to 1 steps along each axis.
  [[nodiscard]] double to(int dx, int dy, int dz) const {
    return squared_(0, dx + 1) + squared_(1, dy + 1) + squared_(2, dz + 1);
  }

 private:
  Eigen::Matrix3d squared_ = Eigen::Matrix3d::Zero();
};

/// Calls `visit(cell)` for the cell of a point and those beside it that come nearer than the square
/// root of `squared_reach`.
template <class Visit>
void visit_cells_in_reach(const Eigen::Vector3d& point, double size, double squared_reach,
                          Visit&& visit) {
  const VoxelIndex index = cell_index(point, 1.0 / size);
  const VoxelKey cell = voxel_key(index);
  const LayerGaps gaps(point, index, size);
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        if (gaps.to(x, y, z) <= squared_reach) visit(cell_beside(cell, x, y, z));
      }
    }
  }
}

}  // namespace raymoval
