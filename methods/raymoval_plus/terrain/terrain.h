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
#include "methods/raymoval_plus/terrain/tiles.h"
#include "methods/remover.h"

namespace raymoval::raymoval_plus_method {

/// Step 1: the height of the ground below every place that was scanned. It is the low quantile of
/// all points of a column. Columns that reach far below their neighbours do not count, and from one
/// column to those around it the ground rises no more than a slope allows.
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
  /// By how much the ground of a tile's columns may rise.
  [[nodiscard]] Window rises_in(const VoxelIndex& tile) const;
  /// The ground of a tile's columns, bounded by that around them.
  [[nodiscard]] Window bounded_in(const VoxelIndex& tile) const;
  [[nodiscard]] Window no_steeper_than_slope(const Window& ground, int margin) const;
  void update_low_quantiles(const RunContext& context);
  /// Writes what is found of each of some tiles.
  void fill_tiles(const VoxelSet& tiles, const RunContext& context, TileHeights& heights,
                  Window (Terrain::*values_in)(const VoxelIndex&) const) const;

  Parameters parameters_;
  double inverse_cell_;
  int reach_;  ///< Columns to either side whose ground bounds that of a column.
  Counts counts_;
  VoxelMap<Stack> stacks_;              ///< By x and y of their blocks.
  std::vector<VoxelKey> stale_;         ///< Stacks whose quantiles are to be found anew.
  std::vector<std::uint8_t> has_news_;  ///< Blocks of `counts_` that `changed_` knows of: 1.
  VoxelSet changed_;                    ///< Tiles in which, or near which, points were added.
  VoxelSet tiles_;                      ///< All that ever were among these.
  /// By column, metres: the ground from its own points, by how much it may rise from one column to
  /// the next, and the ground in the end.
  TileHeights own_ground_, rises_, ground_;
};

}  // namespace raymoval::raymoval_plus_method
