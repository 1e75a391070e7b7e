// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

namespace raymoval {

/// The means of many cells, by number, added up point by point, bit for bit equal to `OffsetMean`
/// of the same points in the same order. It takes 52 bytes per cell while points are added, and 24
/// afterwards, because means are written over the sums.
class MeanTable {
 public:
  MeanTable() = default;
  explicit MeanTable(std::size_t cells);

  void add(std::size_t cell, const Eigen::Vector3d& point) {
    double* const first = numbers_.get() + 6 * cell;
    double* const sum = first + 3;
    const bool is_first = points_[cell]++ == 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (is_first) {
        first[axis] = point[axis];
      } else {
        sum[axis] += point[axis] - first[axis];
      }
    }
  }

  /// Ends adding, once. @return how many cells have a point
  std::size_t finish();

  /// Bytes of memory.
  [[nodiscard]] std::size_t bytes() const {
    return doubles_ * sizeof(double) + points_.capacity() * sizeof(std::uint32_t);
  }

  /// The mean of a cell's points, which are complete; not a number without points.
  [[nodiscard]] Eigen::Vector3d mean(std::size_t cell) const {
    return Eigen::Map<const Eigen::Vector3d>(numbers_.get() + 3 * cell);
  }

 private:
  struct Free {
    void operator()(double* numbers) const { std::free(numbers); }
  };
  /// Of each cell the first point and the sum of all offsets from it; afterwards the mean.
  std::unique_ptr<double[], Free> numbers_;
  std::size_t doubles_ = 0;            ///< How many `numbers_` has.
  std::vector<std::uint32_t> points_;  ///< How many, until the end.
};

}  // namespace raymoval
