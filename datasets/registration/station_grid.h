// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

#include "core/scan/scan.h"

namespace raymoval::registration {

/// Stations, which are poses along a path, in cubic cells, to find those near a position quickly.
class StationGrid {
 public:
  /// @param poses of all stations, which must outlive the grid
  /// @param reach largest distance of a station that is found, metres
  StationGrid(const std::vector<Pose>& poses, double reach) : poses_(poses), reach_(reach) {}

  void add(std::size_t station) {
    cells_[cell_of(poses_[station].translation())].push_back(station);
  }

  /// The nearest station to `position` within the reach for which `is_wanted` is true, else `none`.
  template <class Wanted>
  [[nodiscard]] std::size_t nearest(const Eigen::Vector3d& position, std::size_t none,
                                    Wanted&& is_wanted) const {
    const Cell centre = cell_of(position);
    double least = reach_;
    for (int i = 0; i < 27; ++i) {
      const auto [x, y, z] = centre;
      const auto found = cells_.find({x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1});
      if (found == cells_.end()) continue;
      for (const std::size_t station : found->second) {
        const double apart = (poses_[station].translation() - position).norm();
        if (apart >= least || !is_wanted(station)) continue;
        least = apart;
        none = station;
      }
    }
    return none;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  [[nodiscard]] Cell cell_of(const Eigen::Vector3d& position) const {
    const auto at = [&](int axis) {
      return static_cast<std::int64_t>(std::floor(position[axis] / reach_));
    };
    return {at(0), at(1), at(2)};
  }

  const std::vector<Pose>& poses_;
  double reach_;
  std::map<Cell, std::vector<std::size_t>> cells_;
};

}  // namespace raymoval::registration
