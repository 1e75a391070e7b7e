// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <vector>

#include "core/scan/voxel_key.h"
#include "methods/common/dense_blocks.h"

namespace raymoval::mapcleaner_method {

/// The height of a cell that has none.
inline constexpr double kNoHeight = std::numeric_limits<double>::quiet_NaN();

/// Heights of the cells of the level lattice at the world's origin, metres, in tiles of 64 x 64.
using HeightGrid = DenseBlocks<double, 6, 0>;
inline constexpr int kTileSide = HeightGrid::kSideXY;

/// The cell of a world point; z is 0. @throws DataError beyond the lattice
inline VoxelIndex terrain_cell(const Eigen::Vector3d& world, double inverse_cell) {
  return voxel_index({world.x(), world.y(), 0.0}, inverse_cell);
}

/// A square of cells around a tile, row by row. Heights are relative to `base`, so that single
/// precision holds them.
struct HeightWindow {
  int margin = 0, side = 0;
  double base = 0.0;             ///< The first height of the window, metres.
  std::vector<float> height;     ///< 0 where there is none.
  std::vector<float> is_filled;  ///< 1 where there is a height, else 0.
  bool is_empty = true;
  bool is_full = true;

  /// The place of the tile's cell (x, y), which may be up to `margin` outside.
  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>((y + margin) * side + margin + x);
  }
};

/// @param tile block indices
HeightWindow window_around(const HeightGrid& grid, const VoxelIndex& tile, int margin);

/// Block indices of all tiles of `grid` and of those at most `reach` tiles from one, sorted.
std::vector<VoxelIndex> tiles_around(const HeightGrid& grid, int reach);

}  // namespace raymoval::mapcleaner_method
