// SPDX-License-Identifier: MIT
#include "eval/lattice/cell_means.h"

#include "eval/lattice/cell_lattice.h"

namespace raymoval {

CellMeans::Brick& CellMeans::brick_at(VoxelKey key) {
  const auto [found, is_new] =
      positions_.try_emplace(key, static_cast<std::uint32_t>(bricks_.size()));
  if (is_new) bricks_.emplace_back().fill(kNoCell);
  return bricks_[found->second];
}

void CellMeans::compute(const std::vector<Eigen::Vector3d>& points, double voxel_size) {
  cells_.clear();
  positions_.clear();
  bricks_.clear();
  const double inverse = 1.0 / voxel_size;
  VoxelKey last = 0;  // Neighbours of a ring often share their brick.
  Brick* brick = nullptr;
  for (const Eigen::Vector3d& point : points) {
    const VoxelKey key = cell_key(point, inverse);
    if (brick == nullptr || brick_of(key) != last) {
      last = brick_of(key);
      brick = &brick_at(last);
    }
    std::uint32_t& cell = (*brick)[static_cast<std::size_t>(place_in_brick(key))];
    if (cell == kNoCell) {
      cell = static_cast<std::uint32_t>(cells_.size());
      cells_.push_back({key, {}});
    }
    cells_[cell].mean.add(point);
  }
}

}  // namespace raymoval
