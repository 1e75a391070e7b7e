// SPDX-License-Identifier: MIT
#pragma once

#include <utility>
#include <vector>

#include "methods/erasor/erasor.h"
#include "tests/methods/moved_world.h"

namespace raymoval::erasor_test {

using namespace toy;

using namespace erasor_method;

using Points = std::vector<Eigen::Vector3f>;

/// A coarse grid of 5 rings of 2 m by 8 sectors of 45 degrees, the sensor on the road; of two scans
/// the second is the query.
inline Parameters small_grid() {
  Parameters parameters;
  parameters.sensor_height = 0.0;
  parameters.minimum_range = 0.0;
  parameters.removal_interval = 2;
  parameters.maximum_range = 10.0;
  parameters.rings = 5;
  parameters.sectors = 8;
  parameters.minimum_height = -1.0;
  parameters.maximum_height = 3.0;
  parameters.minimum_points = 3;
  parameters.lowest_skipped = 0;
  parameters.lowest_averaged = 4;
  return parameters;
}

/// Four points of flat road, all in ring 1 (r from 2.55 to 3.64 m), sector 0 (8 to 22 degrees).
inline Points road() {
  return {{2.5F, 0.5F, 0}, {2.5F, 1, 0}, {3.5F, 0.5F, 0}, {3.5F, 1, 0}};
}

/// The road with points above (3, 0.75) at `heights`, in the same bin.
inline Points road_and(const std::vector<float>& heights) {
  Points points = road();
  for (const float z : heights) points.emplace_back(3.0F, 0.75F, z);
  return points;
}

/// Scans from the world's origin.
inline HeldScans scans_of(const std::vector<Points>& all) {
  HeldScans scans;
  for (const Points& points : all) scans.add(points);
  return scans;
}

/// Masks of the scans by the numbers of the points that are removed.
inline std::vector<std::vector<int>> removed_points(const ScanSource& scans,
                                                    const Parameters& parameters) {
  const MaskStore masks = masks_of(*make_erasor(parameters), scans);
  std::vector<std::vector<int>> removed(scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const Mask mask = masks.get(i);
    for (std::size_t k = 0; k < mask.size(); ++k) {
      if (mask[k] != 0) removed[i].push_back(static_cast<int>(k));
    }
  }
  return removed;
}

/// Points of `first` that are removed once `query` has been compared with the map of both.
inline std::vector<int> removed_by(const Points& query, const Points& first,
                                   const Parameters& parameters) {
  return removed_points(scans_of({first, query}), parameters).front();
}

}  // namespace raymoval::erasor_test
