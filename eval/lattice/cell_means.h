// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/scan/voxel_key.h"
#include "eval/points/labelled_voxels.h"

namespace raymoval {

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
