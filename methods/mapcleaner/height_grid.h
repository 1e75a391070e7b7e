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

/// How cells without a height get one from those around them.
struct Fill {
  double radius = 0.0;     ///< In cells; those nearer than this count. 0 fills nothing.
  double deviation = 1.0;  ///< Metres.
  int least_cells = 1;
};

/// Bayesian generalised kernel inference of terrain in two rounds. The first finds the smooth
/// height of every cell with enough others around it, by a kernel of their distance. The second
/// gives it to cells without a height, and weighs those around by how little they deviate from
/// their own smooth height. Cells with a height keep it.
HeightGrid filled(const HeightGrid& grid, const Fill& fill, int threads);

}  // namespace raymoval::mapcleaner_method
