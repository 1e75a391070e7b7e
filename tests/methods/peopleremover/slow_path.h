// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <vector>

#include "core/scan/voxel_key.h"

namespace raymoval::peopleremover_test {

/// All voxels on the way, one step at a time, walls in order of (crossing time, axis).
inline std::vector<VoxelKey> slow_path(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3i last = to.array().floor().cast<int>();
  Eigen::Vector3i at = from.array().floor().cast<int>();
  std::vector<VoxelKey> path{voxel_key(at)};
  while (at != last) {
    double soonest = std::numeric_limits<double>::infinity();
    int axis = -1;
    for (int a = 0; a < 3; ++a) {
      if (at[a] == last[a]) continue;
      const int wall = to[a] > from[a] ? at[a] + 1 : at[a];
      const double time = (wall - from[a]) * (1.0 / (to[a] - from[a]));
      if (axis < 0 || time < soonest) {
        soonest = time;
        axis = a;
      }
    }
    at[axis] += to[axis] > from[axis] ? 1 : -1;
    path.push_back(voxel_key(at));
  }
  return path;
}

}  // namespace raymoval::peopleremover_test
