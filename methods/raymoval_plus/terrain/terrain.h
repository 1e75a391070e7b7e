// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/scan/voxel_key.h"
#include "methods/common/dense_blocks.h"
#include "methods/raymoval_plus/common/parameters.h"
#include "methods/raymoval_plus/common/scan_cells.h"
#include "methods/raymoval_plus/terrain/land.h"
#include "methods/raymoval_plus/terrain/tiles.h"
#include "methods/remover.h"

namespace raymoval::raymoval_plus_method {

/// Step 1: the height of the ground below every place that was scanned. It is the low quantile of
/// all points of a column. Columns that reach far below their neighbours do not count, and from one
/// column to those around it the ground rises no more than a slope allows. Where the land is steep
/// the ground of a column is a plane that rises as the land does, and the slope allowed is that
/// between the ground and such a plane.
///
/// z is taken as up. Memory grows with the columns' occupied 5 cm steps, not with scans.
class Terrain {
 public:
  explicit Terrain(const Parameters& parameters);

  /// Finds the terrain's cells of a scan's points: columns, and steps of height.
  void find_cells_of(const Scan& scan, int threads, ScanCells& cells) const;
  /// Counts the points of a scan. The order of scans does not matter.
  void add(const ScanCells& cells, const RunContext& context);
  /// Finds the ground anew wherever points were added since the last call.
  void update(const RunContext& context);
  /// Finds the heights of a scan's points above the ground, metres. They are +infinity where no
  /// ground is known, and so everywhere if nothing was added.
  void find_heights(const ScanCells& cells, const RunContext& context,
                    std::vector<float>& heights) const;

 private:
  using Counts = DenseBlocks<std::uint32_t, 2, 4>;  ///< A block has 4 x 4 columns, 16 steps of z.
  /// Values of a tile's columns and of those around it, row by row.
  using Window = std::vector<float>;
  static constexpr std::size_t kStackColumns = std::size_t{Counts::kSideXY} * Counts::kSideXY;
  /// The blocks of `counts_` above each other, and what they say of the ground.
  struct Stack {
    int low, high;          ///< z of the lowest and the highest block.
    bool is_stale = false;  ///< Points were added since the quantiles were found.
    /// The low quantile of each column's heights, metres.
    std::array<float, kStackColumns> ground = all_without_ground();
  };
  static constexpr std::array<float, kStackColumns> all_without_ground() {
    std::array<float, kStackColumns> ground{};
    ground.fill(kNoGround);
    return ground;
  }
  /// Remembers that points were added to a block of `counts_`.
  void note_change(std::uint32_t block);
  void mark_changed(const VoxelIndex& block);
  void find_low_quantiles(const VoxelIndex& block, Stack& stack) const;
  /// The low quantiles of a tile's columns and of those around it.
  [[nodiscard]] Window low_quantiles(const VoxelIndex& tile, int margin) const;
  /// The ground of a tile's columns from their own points.
  [[nodiscard]] Window without_pits_in(const VoxelIndex& tile) const;
  /// How much the land of a tile's columns rises along an axis.
  [[nodiscard]] Window land_in(const VoxelIndex& tile, int axis) const;
  /// Columns to either side that bound the ground of a tile.
  [[nodiscard]] int bound_margin() const;
  /// The ground of a tile's columns, bounded by that around them.
  [[nodiscard]] std::vector<GroundPlane> ground_in(const VoxelIndex& tile) const;
  /// Sets the heights of a tile's planes to what the slope between them and the ground around
  /// allows.
  void bound_by_slope(const Window& ground, std::vector<GroundPlane>& planes) const;
  void update_low_quantiles(const RunContext& context);
  /// Those tiles to find anew that have columns at most `margin` columns from what has changed: of
  /// those that ever had points in them or near them, and `fresh` ones, of which nothing was found.
  [[nodiscard]] VoxelSet tiles_to_find(const std::vector<ColumnBox>& changes, int margin,
                                       const VoxelSet& fresh) const;

  Parameters parameters_;
  double inverse_cell_;
  int reach_;  ///< Columns to either side whose ground bounds that of a column.
  Counts counts_;
  VoxelMap<Stack> stacks_;              ///< By x and y of their blocks.
  std::vector<VoxelKey> stale_;         ///< Stacks whose quantiles are to be found anew.
  std::vector<std::uint8_t> has_news_;  ///< Blocks of `counts_` that `changed_` knows of: 1.
  VoxelSet changed_;                    ///< Tiles in which, or near which, points were added.
  VoxelSet tiles_;                      ///< All that ever were among these.
  TileHeights own_ground_;              ///< Of each column from its own points, metres.
  TileHeights land_x_, land_y_;         ///< How much the land rises, see `land_rise`.
  DenseBlocks<GroundPlane, kTileBits, 0> ground_;
};

}  // namespace raymoval::raymoval_plus_method
