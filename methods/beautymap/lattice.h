// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/scan/voxel_key.h"
#include "methods/beautymap/parameters.h"

namespace raymoval::beautymap_method {

inline constexpr int kSlices = 31;          ///< Of a column; the last one has all above, too.
inline constexpr int kTopSlice = 30;        ///< The last one.
inline constexpr int kMostParts = 31;       ///< Of a slice.
inline constexpr int kHighestSlice = 4095;  ///< Slices are not told apart above.

/// The place of a column.
struct ColumnIndex {
  int x = 0;
  int y = 0;

  friend bool operator==(const ColumnIndex&, const ColumnIndex&) = default;
  friend auto operator<=>(const ColumnIndex&, const ColumnIndex&) = default;
};

/// Where columns, slices and their parts are.
struct Lattice {
  explicit Lattice(const Parameters& parameters);

  /// @param world metres
  /// @throws DataError beyond the common lattice
  [[nodiscard]] ColumnIndex column_of(const Eigen::Vector3d& world) const {
    const VoxelIndex cell = voxel_index(
        Eigen::Vector3d(world.x() - origin.x(), world.y() - origin.y(), 0.0), 1.0 / column_size);
    return {cell.x(), cell.y()};
  }
  /// The slice of a height above the column's foot, towards which numbers are cut off: what is
  /// less than a slice below the foot is in slice 0 as well. Negative: below all slices.
  [[nodiscard]] int slice_of(double above_foot) const {
    const double slice = above_foot / slice_height;
    return slice < kHighestSlice ? (slice > -1.0 ? static_cast<int>(slice) : -1) : kHighestSlice;
  }
  /// The part of slice `slice` in which a height above the column's foot is. Negative: below all.
  [[nodiscard]] int part_of(double above_foot, int slice) const {
    const double part = (above_foot - slice * slice_height) / part_height;
    return part > -1.0 ? std::min(static_cast<int>(part), parts - 1) : -1;
  }

  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< Where column (0, 0) begins, metres.
  double column_size, slice_height, part_height;     ///< Metres.
  int parts;                                         ///< Of a slice.
};

}  // namespace raymoval::beautymap_method
