// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <vector>

#include "core/scan/voxel_key.h"
#include "methods/common/dense_blocks.h"
#include "methods/mapcleaner/parameters.h"
#include "methods/remover.h"

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

/// Parameters of filling cells without a height from the cells around them.
struct Fill {
  double radius = 0.0;     ///< In cells; nearer cells count. 0 fills nothing.
  double deviation = 1.0;  ///< Metres.
  int least_cells = 1;
};

/// Bayesian generalised kernel inference of terrain in two rounds. The first finds the smooth
/// height of every cell with enough others around it, by a kernel of their distance. The second
/// fills cells without a height, and weighs the cells around by their deviation from their own
/// smooth height. Cells with a height keep it.
HeightGrid filled(const HeightGrid& grid, const Fill& fill, int threads);

/// The cells with a height of `grid` that can be reached from `starts` (cells), over eight
/// neighbours, through cells whose slope is below `slope` radians. If a start is no such cell, the
/// search begins at the nearest such cells within `start_radius` cells. If the median slope of the
/// cells within that radius is too steep, the start is on a hill, and slopes of its search are
/// relative to that slope.
HeightGrid reachable(const HeightGrid& grid, const std::vector<VoxelIndex>& starts, double cell,
                     double slope, double start_radius);

/// Replaces each height by the median over the cell and its eight neighbours.
HeightGrid smoothed(const HeightGrid& grid, int threads);

/// The height of the terrain: ground that continues without steps from below the sensors. Memory
/// grows with the area of the ground.
class Terrain {
 public:
  using Cursor = HeightGrid::Cursor;
  explicit Terrain(const Parameters& parameters);

  /// Adds the ground points of a scan. @param ground one value per point, 1 = ground
  void add(const Scan& scan, const Mask& ground);
  /// Finds the terrain, once all scans were added. @throws Cancelled
  void finish(const RunContext& context);
  /// The height of the terrain below or above a world point, metres; NaN where there is none.
  [[nodiscard]] double height_at(const Eigen::Vector3d& world, Cursor& cursor) const {
    return heights_.get(terrain_cell(world, inverse_cell_), cursor);
  }
  [[nodiscard]] const HeightGrid& heights() const { return heights_; }

 private:
  /// Of the heights of a cell's ground points.
  struct Statistics {
    double count = 0.0, mean = 0.0;
    double squares = 0.0;  ///< Sum of squared differences from their mean.
  };
  using StatisticsGrid = DenseBlocks<Statistics, 6, 0>;

  [[nodiscard]] HeightGrid measured() const;

  Parameters parameters_;
  double inverse_cell_;
  StatisticsGrid statistics_{Statistics{}};
  std::vector<VoxelIndex> below_sensors_;  ///< Cells below the sensor, one per scan.
  HeightGrid heights_{kNoHeight};
};

}  // namespace raymoval::mapcleaner_method
