// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/scan/voxel_key.h"

namespace raymoval {

/// Mean of points that come one by one, summed as offsets from the first one, so that it is as
/// exact far from the origin as near it. The same points in the same order give the same bits.
struct OffsetMean {
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();  ///< Of the offsets of all points but the first.
  std::uint32_t points = 0;

  void add(const Eigen::Vector3d& point) {
    if (points++ == 0) {
      first = point;
    } else {
      sum += point - first;
    }
  }
  /// @return not a number without points
  [[nodiscard]] Eigen::Vector3d mean() const { return first + sum / static_cast<double>(points); }
};

/// The means of one scan's points, cell by cell.
class CellMeans {
 public:
  struct Cell {
    VoxelKey key;
    OffsetMean mean;
  };

  /// Makes the means of another scan. @param points world frame. @throws DataError beyond the
  /// lattice
  void compute(const std::vector<Eigen::Vector3d>& points, double voxel_size);
  /// In the order in which the points came to them.
  [[nodiscard]] const std::vector<Cell>& cells() const { return cells_; }

 private:
  static constexpr std::uint32_t kNoCell = 0xFFFFFFFFU;
  using Brick = std::array<std::uint32_t, 64>;  ///< For each place the cell in `cells_`.
  Brick& brick_at(VoxelKey key);

  std::vector<Cell> cells_;
  VoxelMap<std::uint32_t> positions_;
  std::vector<Brick> bricks_;
};

}  // namespace raymoval
