// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "methods/hmm_mos/scan_voxels.h"

namespace raymoval::hmm_mos_method {

/// Rows of bytes, `stride` bytes apart, of which some are used.
struct NearRows {
  const std::uint8_t* rows = nullptr;  ///< Row 0; 64 bytes each.
  std::ptrdiff_t stride = 0;
  std::uint64_t which = 0;             ///< Bit k: row k is used.
  const std::uint8_t* away = nullptr;  ///< By row: its loss of nearness.
};

/// The innermost loop of the distances, compiled for each instruction set: raises bytes of the row
/// `nearest` to the largest byte of the rows minus `away` of its row, at least 0. It does so for
/// the bytes from `first` to `last`, and possibly for others.
using TakeNearest = void (*)(const NearRows& rows, std::size_t first, std::size_t last,
                             std::uint8_t* nearest);

/// Step 3: squared distances from the observed voxels of a block to the nearest occupied voxel of
/// this scan and the one before, in voxels, also to those beyond the range. They are exact below a
/// bound and equal to it beyond (Euclidean distance transform, one axis after the other).
///
/// Internally, bytes hold a nearness: the bound minus the squared distance, so that 0 means the
/// bound.
class DistanceField {
 public:
  /// @param far the bound, 1 to 254
  explicit DistanceField(int far);

  /// @param beyond occupied voxels of both scans beyond their ranges, see `find_beyond`
  /// @param block of `now`
  void find(const ScanGrid& now, const ScanGrid& before, const ScanGrid& beyond,
            const ScanBlock& block);

  /// The squared distance of an observed voxel of the block, at most `far`.
  [[nodiscard]] int at(std::size_t column, int height) const {
    return far_ - nearness_[column][static_cast<std::size_t>(height)];
  }

 private:
  using Row = std::array<std::uint8_t, kHeight>;  ///< Nearness of the voxels of a column.

  void find_heights(const ScanBlock& block);
  void find_neighbours(const std::array<const ScanGrid*, 3>& grids, const ScanBlock& block);
  void along_z();
  void find_occupied(int x);
  void fill_column(const std::array<std::uint64_t, 3>& occupied, Row& row) const;
  void along_y();
  void along_x(const ScanBlock& block);

  int far_;
  int margin_;  ///< Voxels around a block that may be nearer than `far_`.
  int width_;   ///< Of a block with its margins.
  TakeNearest take_nearest_;
  std::vector<std::uint8_t> ramp_;  ///< Nearness by difference of heights, from the least one.
  std::vector<std::uint8_t> away_;  ///< Squares of -margin to +margin.

  std::size_t lowest_ = 0, highest_ = 0;  ///< Heights of the block that are observed.
  /// Of each grid, the blocks around by their offsets, x slowest; or null.
  std::array<std::array<const ScanBlock*, 27>, 3> around_{};
  /// Occupied voxels of the grids at some x, by y with margins: below the block, in it, and above.
  std::array<std::array<std::uint64_t, 64>, 3> occupied_{};
  std::vector<Row> of_columns_;  ///< To voxels in the same column; by x, y, with margins.
  std::vector<Row> of_rows_;     ///< To voxels with the same x; by x, with margins, and y.
  std::vector<Row> nearness_;    ///< By column of the block.
  std::vector<std::uint64_t>
      columns_;  ///< By x: bit y if that column of `of_columns_` is not empty.
  std::array<std::uint64_t, kSide>
      rows_{};  ///< By y: bit x if that row of `of_rows_` is not empty.
};

}  // namespace raymoval::hmm_mos_method
