// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "methods/raymoval/kernels/angular_grid.h"

namespace raymoval::raymoval_method {

/// The wanted bins of a grid, whose first hits are required: one bit each, column by column.
class WantedBins {
 public:
  /// Marks all bins as wanted.
  void request_all(const AngularGrid& grid);
  /// Marks the bins within `radius` columns and rows of each bin where `values` is finite. The
  /// azimuth wraps around.
  /// @param values one per bin of `grid`
  void request_around(const std::vector<float>& values, const AngularGrid& grid, int radius);

  /// The wanted rows of column `i`: bit j % 64 of word j / 64 is row j. The bit after the last row
  /// exists and is never set.
  [[nodiscard]] const std::uint64_t* column(int i) const {
    return columns_.data() + static_cast<std::size_t>(i) * words_;
  }
  [[nodiscard]] std::size_t words_a_column() const { return words_; }
  [[nodiscard]] bool contains(const AngularGrid& grid, int bin) const {
    const auto row = static_cast<std::size_t>(grid.elevation_of(bin));
    return (column(grid.azimuth_of(bin))[row / 64] >> row % 64 & 1) != 0;
  }

 private:
  std::size_t words_ = 0;
  std::vector<std::uint64_t> columns_;
  std::vector<std::uint64_t> finite_;  ///< Kept for its memory.
};

}  // namespace raymoval::raymoval_method
