// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/scan/voxel_key.h"

namespace raymoval {

/// Finds the occupied cells around a query among sorted keys, for queries in non-decreasing order
/// of their cells. Cells that differ in x only are neighbours in the sorted keys, so nine cursors
/// (three rows in y times three in z) that move forward replace a hash table.
///
/// @note Covers the 27 cells around the query's own, so it finds everything within one cell's edge.
class CellNeighbours {
 public:
  /// @param keys sorted, without repetition; must outlive this object
  CellNeighbours(const std::vector<VoxelKey>& keys, double voxel_size)
      : keys_(keys), voxel_size_(voxel_size) {}

  /// Calls `visit(position in keys)` for the occupied cells around `cell` whose distance from
  /// `query` is at most `reach()`, a distance in metres that may shrink from call to call. The cell
  /// itself comes first. A margin of 1e-9 m on distances covers rounding.
  /// @param query point in or (by rounding) on `cell`
  template <class Reach, class Visit>
  void visit(VoxelKey cell, const Eigen::Vector3d& query, Reach&& reach, Visit&& visit_cell) {
    const Gaps gaps = gaps_of(cell, query);
    for (const Row& row : kRows) {
      const double row_gap = gaps.y[row.dy + 1] + gaps.z[row.dz + 1];
      if (row_gap > squared(reach() + kMargin)) continue;
      const VoxelKey centre = shifted(cell, row);
      for (std::size_t i = advance(row, centre - 1); i < keys_.size() && keys_[i] <= centre + 1;
           ++i) {
        const double gap = row_gap + gaps.x[keys_[i] + 1 - centre];
        if (gap <= squared(reach() + kMargin)) visit_cell(i);
      }
    }
  }

 private:
  static constexpr double kMargin = 1e-9;
  struct Row {
    int dy, dz;
  };
  /// The query's row is first, so that the reach shrinks early.
  static constexpr std::array<Row, 9> kRows = {
      {{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}}};

  /// Squared distance from the query to the lower, own and upper layer of each axis.
  struct Gaps {
    std::array<double, 3> x, y, z;
  };

  static double squared(double value) { return value * value; }
  static VoxelKey shifted(VoxelKey cell, const Row& row) {
    return cell + (static_cast<VoxelKey>(static_cast<std::int64_t>(row.dy)) << kVoxelBits) +
           (static_cast<VoxelKey>(static_cast<std::int64_t>(row.dz)) << (2 * kVoxelBits));
  }
  [[nodiscard]] std::array<double, 3> axis_gaps(double coordinate, int index) const {
    const double below = std::max(0.0, coordinate - index * voxel_size_);
    const double above = std::max(0.0, (index + 1) * voxel_size_ - coordinate);
    return {squared(below), 0.0, squared(above)};
  }
  [[nodiscard]] Gaps gaps_of(VoxelKey cell, const Eigen::Vector3d& query) const {
    const VoxelIndex index = voxel_index(cell);
    return {axis_gaps(query.x(), index.x()), axis_gaps(query.y(), index.y()),
            axis_gaps(query.z(), index.z())};
  }
  /// First position of `row`'s cursor whose key is not below `key`.
  std::size_t advance(const Row& row, VoxelKey key) {
    std::size_t& cursor = cursors_[static_cast<std::size_t>((row.dz + 1) * 3 + row.dy + 1)];
    for (int steps = 0; cursor < keys_.size() && keys_[cursor] < key; ++steps) {
      ++cursor;
      if (steps == kLinearSteps) {  // A long jump, such as the first one.
        const auto from = keys_.begin() + static_cast<std::ptrdiff_t>(cursor);
        cursor = static_cast<std::size_t>(std::lower_bound(from, keys_.end(), key) - keys_.begin());
      }
    }
    return cursor;
  }

  static constexpr int kLinearSteps = 16;
  const std::vector<VoxelKey>& keys_;
  double voxel_size_;
  std::array<std::size_t, 9> cursors_{};
};

}  // namespace raymoval
