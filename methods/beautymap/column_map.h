// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/scan/scan.h"
#include "core/scan/voxel_key.h"
#include "methods/beautymap/beautymap.h"

namespace raymoval::beautymap_method {

inline constexpr int kSlices = 31;    ///< Of a column; the last slice also holds all higher points.
inline constexpr int kTopSlice = 30;  ///< The last one.
inline constexpr int kMostParts = 31;       ///< Of a slice.
inline constexpr int kHighestSlice = 4095;  ///< Higher slices are not distinguished.

/// Reach of the neighbour columns with which a column's lowest point is compared; a constant of the
/// public program.
inline constexpr int kOutlierReach = 5;

/// The place of a column.
struct ColumnIndex {
  int x = 0;
  int y = 0;

  friend bool operator==(const ColumnIndex&, const ColumnIndex&) = default;
  friend auto operator<=>(const ColumnIndex&, const ColumnIndex&) = default;
};

/// The lattice of columns, slices and their parts.
struct Lattice {
  explicit Lattice(const Parameters& parameters);

  /// @param world metres
  /// @throws DataError beyond the common lattice
  [[nodiscard]] ColumnIndex column_of(const Eigen::Vector3d& world) const {
    const VoxelIndex cell = voxel_index(
        Eigen::Vector3d(world.x() - origin.x(), world.y() - origin.y(), 0.0), 1.0 / column_size);
    return {cell.x(), cell.y()};
  }
  /// The slice of a height above the column's foot, rounded towards the foot: a height less than
  /// one slice below the foot is in slice 0 too. Negative: below all slices.
  [[nodiscard]] int slice_of(double above_foot) const {
    const double slice = above_foot / slice_height;
    return slice < kHighestSlice ? (slice > -1.0 ? static_cast<int>(slice) : -1) : kHighestSlice;
  }
  /// The part of slice `slice` that holds a height above the column's foot. Negative: below all
  /// parts.
  [[nodiscard]] int part_of(double above_foot, int slice) const {
    const double part = (above_foot - slice * slice_height) / part_height;
    return part > -1.0 ? std::min(static_cast<int>(part), parts - 1) : -1;
  }

  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< The corner of column (0, 0), metres.
  double column_size, slice_height, part_height;     ///< Metres.
  int parts;                                         ///< Of a slice.
};

inline VoxelKey column_key(const ColumnIndex& column) {
  return voxel_key(column.x, column.y, 0);
}

/// The height of the lowest point of each column by its key, metres.
using LowestPoints = VoxelMap<double>;

/// One column of the map.
struct Column {
  ColumnIndex index;
  double foot = 0.0;           ///< Start of slice 0: the lowest point, unless it is an outlier.
  bool is_outlier = false;     ///< Whether its lowest point was moved.
  std::uint32_t occupied = 0;  ///< Bit i: slice i holds points.
  int last_slice = -1;         ///< The highest slice of the column; above it is a gap.
  std::uint32_t removed = 0;   ///< Slices whose points are all removed.
  std::vector<std::uint32_t> points;         ///< Of each part of each slice, `parts` a slice.
  std::vector<std::uint32_t> removed_parts;  ///< By slice; bit i: part i is removed.
};

/// The place of a point in the map.
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

  /// Step 3 for the points of a scan, which must be among the points of `lowest`.
  void place(const Scan& scan, std::vector<PlacedPoint>& placed) const;
  /// Counts a scan's points.
  void add(const std::vector<PlacedPoint>& placed);
  /// Steps 4 and 5, once all scans were counted: which slices belong to their columns.
  void finish();

  /// Whether a placed point is in a marked slice or part.
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
  VoxelMap<std::uint32_t> numbers_;
  double lowest_ = 0.0;
};

/// The lowest points of one scan.
LowestPoints lowest_points(const Scan& scan, const Lattice& lattice);
/// Adds the lowest points of a scan to those of all scans.
void add_lowest(const LowestPoints& of_scan, LowestPoints& lowest);

/// The slices and parts that one scan removes from the map.
struct Marks {
  struct Slices {
    std::uint32_t column;
    std::uint32_t slices;  ///< Bit i: slice i is removed.
  };
  struct Parts {
    std::uint32_t column;
    int slice;
    std::uint32_t parts;  ///< Bit i: part i of the slice is removed.
  };
  std::vector<Slices> slices;
  std::vector<Parts> parts;
};

/// Section B of the description: slices that are occupied in the map and not in the scan, and that
/// the scan could see.
/// @param placed the places of the scan's points in the map
Marks judge(const Parameters& parameters, const ColumnMap& map, const Scan& scan,
            const std::vector<PlacedPoint>& placed);

/// Adds the marks of a scan to the map.
void add_marks(const Marks& marks, ColumnMap& map);

}  // namespace raymoval::beautymap_method
