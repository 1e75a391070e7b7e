// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "core/scan/voxel_key.h"
#include "methods/raymoval_plus/common/dense_blocks.h"
#include "methods/raymoval_plus/common/parameters.h"
#include "methods/remover.h"

namespace raymoval::raymoval_plus_method {

/// The number of points that one thread takes at a time: enough that starting a task costs little,
/// and few enough that a scan of 120,000 points makes 15 tasks. It changes no answer.
inline constexpr std::size_t kPointsATask = 8192;

/// Step 1: the height of the ground below every place that was scanned. It is the low quantile of
/// all points of a column. Columns that reach far below their neighbours do not count, and from one
/// column to those around it the ground rises no more than a slope allows.
///
/// z is taken as up. Memory grows with the columns' occupied 5 cm steps, not with scans.
class Terrain {
 public:
  explicit Terrain(const Parameters& parameters);

  /// Counts the points of a scan (world frame, metres). The order of scans does not matter.
  void add(const std::vector<Eigen::Vector3d>& points, const RunContext& context);
  /// Finds the ground anew wherever points were added since the last call.
  void update(const RunContext& context);
  /// Heights of world points above the ground, metres. They are +infinity where no ground is known,
  /// and so everywhere if nothing was added.
  [[nodiscard]] std::vector<float> heights(const std::vector<Eigen::Vector3d>& points,
                                           const RunContext& context) const;

 private:
  using Heights = DenseBlocks<float, 6, 0>;         ///< A block is a tile of 64 x 64 columns.
  using Counts = DenseBlocks<std::uint32_t, 2, 4>;  ///< A block has 4 x 4 columns, 16 steps of z.
  static constexpr int kTile = Heights::kSideXY;
  /// The ground of a tile's columns and of those around it, row by row.
  using Window = std::vector<float>;
  void mark_changed(const VoxelIndex& block);
  [[nodiscard]] Window low_quantiles(const VoxelIndex& tile) const;
  void fill_quantiles(const VoxelIndex& block, int low_z, int high_z, int left, int bottom,
                      Window& window) const;
  [[nodiscard]] Window without_pits(const Window& ground) const;
  [[nodiscard]] Window no_steeper_than_slope(const Window& ground) const;

  Parameters parameters_;
  double inverse_cell_;
  int reach_;   ///< Columns to either side whose ground bounds that of a column.
  int margin_;  ///< Columns to either side of a tile that its ground depends on.
  int side_;    ///< Columns in a row of a window.
  Counts counts_;
  VoxelMap<std::pair<int, int>>
      extents_;       ///< The lowest and the highest block above 4 x 4 columns.
  VoxelSet changed_;  ///< Tiles whose ground may have changed.
  Heights ground_;
};

}  // namespace raymoval::raymoval_plus_method
