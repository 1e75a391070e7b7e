// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "core/scan/voxel_key.h"
#include "methods/raymoval_plus/dense_blocks.h"
#include "methods/raymoval_plus/parameters.h"

namespace raymoval {

/// Height of the ground below every place that was scanned: the low quantile of all points of a
/// column, freed of columns that reach far below their neighbours, and no steeper than a slope.
///
/// z is taken as up. Memory grows with the columns' occupied 5 cm steps, not with scans.
class Terrain {
 public:
  using Heights = DenseBlocks<float, 6, 0>;  ///< 64 x 64 columns: a tile.

  explicit Terrain(const RaymovalPlusParameters& parameters);

  /// Counts the points of a scan (world frame, metres). Order does not matter.
  void add(const std::vector<Eigen::Vector3d>& points);
  /// Finds the ground from all points counted so far, where they have changed.
  void update(int threads);
  /// Height of a world point above the ground, metres; +infinity where no ground is known.
  [[nodiscard]] float height(const Eigen::Vector3d& point, Heights::Cursor& cursor) const {
    const VoxelIndex column(static_cast<int>(std::floor(point.x() * inverse_cell_)),
                            static_cast<int>(std::floor(point.y() * inverse_cell_)), 0);
    return static_cast<float>(point.z()) - ground_.get(column, cursor);
  }

 private:
  using Counts = DenseBlocks<std::uint32_t, 2, 4>;  ///< 4 x 4 columns, 16 steps of z.
  using Window = std::vector<float>;  ///< A tile's columns and those around; row by row.
  void note_change(const VoxelIndex& block);
  [[nodiscard]] Window low_quantiles(const VoxelIndex& tile) const;
  void fill_quantiles(const VoxelIndex& block, int low_z, int high_z, int left, int bottom,
                      Window& window) const;
  [[nodiscard]] Window without_pits(const Window& ground) const;
  [[nodiscard]] Window no_steeper_than_slope(const Window& ground) const;

  RaymovalPlusParameters parameters_;
  double inverse_cell_;
  int reach_;   ///< Columns whose ground bounds that of a column.
  int margin_;  ///< Columns around a tile that its ground depends on.
  int side_;    ///< Of a window.
  Counts counts_;
  VoxelMap<std::pair<int, int>> extents_;  ///< Lowest and highest block by block of columns.
  VoxelSet changed_;                       ///< Tiles to be found again.
  Heights ground_;
};

}  // namespace raymoval
