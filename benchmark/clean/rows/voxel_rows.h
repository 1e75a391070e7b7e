// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "benchmark/clean/rows/map_rows.h"
#include "core/scan/voxel_key.h"

namespace raymoval {

/// Keeps one row for each occupied cell of space, so that memory is bounded by the map. A row has
/// the mean position and the mean intensity of the cell's points. All other fields are those of the
/// point nearest to the centre of the cell, the first of several.
class VoxelRows {
 public:
  /// @param cell_size in metres
  /// @param origin of the cells
  VoxelRows(const RecordLayout& layout, double cell_size, const Eigen::Vector3d& origin);

  /// Adds row `point` of a scan.
  void add(const ScanRows& scan, std::size_t point);
  /// Passes on all cells, ordered by x, then y, then z, in pieces, and releases them.
  void take(const std::function<void(const ScanRows& piece)>& give);

 private:
  struct Cell {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();  ///< From `origin`.
    double intensity = 0.0;
    std::uint64_t count = 0;
    std::uint64_t row = 0;  ///< Number among those of `blocks_`.
    float from_middle = std::numeric_limits<float>::infinity();  ///< Squared, in cells.
  };
  [[nodiscard]] std::byte* row_of(const Cell& cell) const;
  void keep_row(Cell& cell, bool is_new, const std::byte* row);
  void append(const Cell& cell, ScanRows& piece) const;

  RecordLayout layout_;
  PositionFields at_;
  std::optional<PointField> intensity_;
  bool keeps_rows_;  ///< Whether rows have fields other than position and intensity.
  double cell_size_;
  Eigen::Vector3d origin_;
  VoxelMap<Cell> cells_;
  std::vector<std::unique_ptr<std::byte[]>> blocks_;  ///< Rows that never move.
};

}  // namespace raymoval
