// SPDX-License-Identifier: MIT
#include "eval/lattice/mean_table.h"

#include <algorithm>
#include <new>

namespace raymoval {

MeanTable::MeanTable(std::size_t cells)
    : numbers_(static_cast<double*>(std::calloc(std::max<std::size_t>(cells, 1), 48))),
      doubles_(6 * cells),
      points_(cells, 0) {
  if (numbers_ == nullptr) throw std::bad_alloc();
}

std::size_t MeanTable::finish() {
  std::size_t filled = 0;
  double* const numbers = numbers_.get();
  for (std::size_t cell = 0; cell < points_.size(); ++cell) {
    // A mean is never written beyond its own sums.
    const double* const first = numbers + 6 * cell;
    const Eigen::Map<const Eigen::Vector3d> sum(first + 3);
    const Eigen::Vector3d mean =
        Eigen::Map<const Eigen::Vector3d>(first) + sum / static_cast<double>(points_[cell]);
    Eigen::Map<Eigen::Vector3d>(numbers + 3 * cell) = mean;
    filled += points_[cell] > 0 ? 1 : 0;
  }
  // Shrinking does not move the memory, so it is never there twice.
  void* const means =
      std::realloc(numbers, std::max<std::size_t>(points_.size(), 1) * 3 * sizeof(double));
  if (means != nullptr) {
    (void)numbers_.release();
    numbers_.reset(static_cast<double*>(means));
    doubles_ = 3 * points_.size();
  }
  points_ = {};
  return filled;
}

}  // namespace raymoval
