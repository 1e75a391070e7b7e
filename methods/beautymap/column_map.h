// SPDX-License-Identifier: MIT
#pragma once

#include <tsl/robin_map.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/scan/scan.h"
#include "methods/beautymap/lattice.h"

namespace raymoval::beautymap_method {

/// The least and the greatest coordinates of the map, and the lowest point of each column.
struct LowestPoints {
  tsl::robin_map<VoxelKey, double, VoxelKeyHash> of_column;  ///< By `column_key`; z, metres.

  void add(const LowestPoints& other);
};

inline VoxelKey column_key(const ColumnIndex& column) {
  return voxel_key(column.x, column.y, 0);
}

/// One column of the map.
struct Column {
  ColumnIndex index;
  double foot = 0.0;        ///< Where slice 0 begins: the lowest point, unless it was an outlier.
  bool is_outlier = false;  ///< Whether its lowest point was moved.
  std::uint32_t occupied = 0;  ///< Bit i: slice i holds points.
  int last_slice = -1;         ///< The highest that is a part of the column; above it is a gap.
  std::uint32_t removed = 0;   ///< Slices of which all points go.
  std::vector<std::uint32_t> points;         ///< Of each part of each slice, `parts` a slice.
  std::vector<std::uint32_t> removed_parts;  ///< By slice; bit i: the points of part i go.
};

/// Where a point is in the map.
struct PlacedPoint {
  std::uint32_t column = 0;  ///< Number of the column.
  std::int16_t slice = -1;   ///< Negative: below all slices.
  std::int16_t part = -1;    ///< Of the slice.
};

/// Section A of the description: all points of all scans in columns, slices, and parts of slices.
class ColumnMap {
 public:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  /// Steps 1 and 2: columns with their feet.
  ColumnMap(const Parameters& parameters, const Lattice& lattice, const LowestPoints& lowest);

  /// Step 3 for the points of a scan, each of which was one of `lowest`'s.
  void place(const Scan& scan, std::vector<PlacedPoint>& placed) const;
  /// Counts a scan's points.
  void add(const std::vector<PlacedPoint>& placed);
  /// Steps 4 and 5, once all scans were counted: which slices belong to their columns.
  void finish();

  /// Whether a placed point goes by what was marked.
  [[nodiscard]] bool is_removed(const PlacedPoint& point) const;

  /// The column's number, or `kNone`.
  [[nodiscard]] std::uint32_t find(const ColumnIndex& column) const {
    const auto found = numbers_.find(column_key(column));
    return found == numbers_.end() ? kNone : found->second;
  }
  [[nodiscard]] const std::vector<Column>& columns() const { return columns_; }
  [[nodiscard]] std::vector<Column>& columns() { return columns_; }
  [[nodiscard]] const Lattice& lattice() const { return lattice_; }
  /// The lowest point of all, metres.
  [[nodiscard]] double lowest() const { return lowest_; }

 private:
  void place_feet(const LowestPoints& lowest);
  [[nodiscard]] std::vector<double> lowest_around(const Column& column,
                                                  const LowestPoints& lowest) const;
  [[nodiscard]] bool holds_points(const Column& column, int slice) const;

  Parameters parameters_;
  Lattice lattice_;
  std::vector<Column> columns_;  ///< In order of x, then y.
  tsl::robin_map<VoxelKey, std::uint32_t, VoxelKeyHash> numbers_;
  double lowest_ = 0.0;
};

/// The lowest points of one scan.
LowestPoints lowest_points(const Scan& scan, const Lattice& lattice);

}  // namespace raymoval::beautymap_method
