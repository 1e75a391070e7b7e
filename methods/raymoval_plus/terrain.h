// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/voxel_key.h"
#include "methods/raymoval_plus/parameters.h"

namespace raymoval {

/// Height of the ground below every place that was scanned: the low quantile of all points of a
/// column, freed of columns that reach far below their neighbours, and no steeper than a slope.
///
/// z is taken as up. Memory grows with the columns' occupied 5 cm steps, not with scans.
class Terrain {
 public:
  explicit Terrain(const RaymovalPlusParameters& parameters);

  /// Counts a point of the world frame, metres. Order does not matter.
  void add(const Eigen::Vector3d& point);
  /// Finds the ground; call after the last `add`.
  void finish(int threads);
  /// Height of a world point above the ground, metres; +infinity where no ground is known.
  [[nodiscard]] float height(const Eigen::Vector3d& point) const;

 private:
  struct Column {
    int x, y;
    float ground;
  };
  using Grid = VoxelMap<float>;  ///< Ground height by column, key (x, y, 0).
  [[nodiscard]] Grid low_quantiles();
  [[nodiscard]] Grid without_pits(const Grid& ground, int threads) const;
  [[nodiscard]] Grid no_steeper_than_slope(const Grid& ground, int threads) const;

  RaymovalPlusParameters parameters_;
  double inverse_cell_;
  VoxelMap<std::uint32_t> counts_;  ///< Points by column and 5 cm step of z.
  Grid ground_;
};

}  // namespace raymoval
