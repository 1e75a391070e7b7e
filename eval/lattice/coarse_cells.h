// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/scan/voxel_key.h"
#include "eval/lattice/cell_lattice.h"

namespace raymoval {

/// The places where some cells of a lattice are, in a dense grid of coarse cells around them. For
/// most points it shows without a search that they are in none of these cells, and it is never
/// wrong about this. It takes at most 2 MiB: the farther the cells are apart, the coarser it is.
class CoarseCells {
 public:
  CoarseCells() = default;
  /// @param cells_a_metre as points are taken to cells of the lattice
  /// @param visit_all calls a function that it gets with each cell's `VoxelIndex`; called twice
  template <class VisitAll>
  CoarseCells(double cells_a_metre, VisitAll&& visit_all) : cells_a_metre_(cells_a_metre) {
    VoxelIndex low = VoxelIndex::Constant(std::numeric_limits<int>::max()), high = -low;
    visit_all([&](const VoxelIndex& cell) {
      low = low.cwiseMin(cell);
      high = high.cwiseMax(cell);
    });
    if (low.x() <= high.x()) choose_grid(low, high);
    visit_all([&](const VoxelIndex& cell) {
      const std::size_t number = number_of(cell);
      words_[number / 64] |= std::uint64_t{1} << (number % 64);
    });
  }

  /// Whether a point of the world (metres) may be in one of the cells.
  [[nodiscard]] bool may_hold(const Eigen::Vector3d& point) const {
    const Eigen::Array3d in_cells = point.array() * cells_a_metre_;
    if (!(in_cells >= from_).all() || !(in_cells < to_).all()) return false;
    const std::size_t number = number_of(cell_index(point, cells_a_metre_));
    return (words_[number / 64] >> (number % 64) & 1U) != 0;
  }

 private:
  static constexpr std::uint64_t kMostCells = std::uint64_t{1} << 24;

  void choose_grid(const VoxelIndex& low, const VoxelIndex& high) {
    low_ = low;
    from_ = low.array().cast<double>();
    to_ = high.array().cast<double>() + 1.0;
    const auto cells_along = [&](int axis) {
      return (static_cast<std::uint64_t>(high[axis] - low[axis]) >> shift_) + 1;
    };
    // Each factor is at most 2^21, so that a product of all fits 64 bits.
    while (cells_along(0) * cells_along(1) * cells_along(2) > kMostCells) ++shift_;
    row_ = cells_along(0);
    plane_ = row_ * cells_along(1);
    words_.assign(plane_ * cells_along(2) / 64 + 1, 0);
  }

  [[nodiscard]] std::size_t number_of(const VoxelIndex& cell) const {
    const auto along = [&](int axis) {
      return static_cast<std::size_t>((cell[axis] - low_[axis]) >> shift_);
    };
    return along(2) * plane_ + along(1) * row_ + along(0);
  }

  double cells_a_metre_ = 1.0;
  VoxelIndex low_ = VoxelIndex::Zero();
  Eigen::Array3d from_ = Eigen::Array3d::Zero(),
                 to_ = from_;        ///< Bounds in cells; `to_` is beyond.
  int shift_ = 1;                    ///< A coarse cell has 2^`shift_` cells along each axis.
  std::size_t row_ = 1, plane_ = 1;  ///< Coarse cells in a row and in a plane.
  std::vector<std::uint64_t> words_ = {0};
};

}  // namespace raymoval
