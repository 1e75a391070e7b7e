// SPDX-License-Identifier: MIT
#pragma once

#include "methods/dufomap/scan_grid.h"

namespace raymoval::dufomap {

/// Marks the voxels that beams of one scan pass through (first part of step 3).
///
/// A beam is walked from column to column in the x-y plane only; in each column the voxels between
/// its heights at entry and exit are marked at once. Within a block all is whole-number arithmetic
/// in fixed point without branches on the direction, which no processor could foretell.
class FreeWalk {
 public:
  /// Longest beam, in voxels.
  static constexpr double kLongest = 1 << 17;

  /// @param sensor world position in voxels
  /// @param grid holds the hits of the scan
  FreeWalk(const Eigen::Vector3d& sensor, bool pass_through_hits, ScanGrid& grid);

  /// Marks the voxels of a beam up to and including the first hit, if it enters one.
  /// @param direction of unit length
  /// @param length of the beam in voxels, at most `kLongest`
  /// @return the last voxel marked
  VoxelIndex mark_free(const Eigen::Vector3d& direction, double length);

 private:
  using Fixed = std::int64_t;  ///< Voxels times 2^40.

  /// One of the two level axes: when the beam crosses its next wall, and how high it is then.
  struct Axis {
    Fixed next, delta;
    Fixed height, rise;
    int step;       ///< +1 or -1.
    int to_column;  ///< What a step adds to the number of the column.
    /// When the beam leaves the block, from the place of its column in the block.
    [[nodiscard]] Fixed block_exit(int place) const {
      return next + (step > 0 ? kSide - 1 - place : place) * delta;
    }
    void advance() {
      next += delta;
      height += rise;
    }
  };

  [[nodiscard]] Axis axis_of(Eigen::Index k, const Eigen::Vector3d& direction) const;
  [[nodiscard]] Fixed height_exit(const Eigen::Vector3d& direction) const;
  [[nodiscard]] int height_in_block(Fixed height) const;
  bool walk_block(ScanBlock& block, Fixed limit);
  bool leave_block(ScanBlock& block, const Eigen::Vector3d& direction, double length, Fixed limit,
                   const std::array<Fixed, 3>& exits);
  bool mark(Column& column, int to);
  [[nodiscard]] VoxelIndex voxel() const;

  bool pass_through_hits_;
  ScanGrid& grid_;
  VoxelIndex sensor_block_;
  Eigen::Vector3d sensor_;  ///< Voxels from the low corner of the sensor's block.

  // The beam under way.
  Axis x_{}, y_{};
  bool rises_ = false;
  VoxelIndex block_at_;
  int column_ = 0;
  int z_ = 0;  ///< In the block.
};

}  // namespace raymoval::dufomap
