// SPDX-License-Identifier: MIT
#pragma once

#include <octomap/OcTree.h>

#include <vector>

#include "methods/octomap/occupancy_map.h"
#include "tests/methods/moved_world.h"

namespace raymoval::octomap_test {

using namespace toy;

using namespace octomap_method;

using Points = std::vector<Eigen::Vector3d>;

/// Scans given point by point in world coordinates; the sensor's axes are the world's.
class HandScans : public HeldScans {
 public:
  HandScans& add(const Points& points, const Eigen::Vector3d& origin = {0.1, 0.1, 0.1}) {
    add_world(origin, points);
    return *this;
  }
};

inline octomap::point3d rounded(const Eigen::Vector3d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

inline std::vector<octomap::point3d> rounded(const Points& points) {
  std::vector<octomap::point3d> all;
  for (const Eigen::Vector3d& p : points) all.push_back(rounded(p));
  return all;
}

/// The map alone, a scan at a time, kept to the cells around the line on which tests happen.
class HandMap {
 public:
  explicit HandMap(const Parameters& parameters) : parameters_(parameters), map_(parameters_) {
    for (double x = -0.5; x < 3.6; x += 0.2) {
      for (double y = -0.5; y < 0.6; y += 0.2) {
        for (double z = -0.5; z < 1.6; z += 0.2) map_.keep(*map_.cell_of(rounded({x, y, z})));
      }
    }
  }
  HandMap(const HandMap&) = delete;
  HandMap& operator=(const HandMap&) = delete;

  HandMap& insert(const Points& points, const Eigen::Vector3d& origin = {0.1, 0.1, 0.1},
                  PointRole role = PointRole::kSurface) {
    map_.insert(rounded(points), std::vector<PointRole>(points.size(), role), rounded(origin), {});
    return *this;
  }
  [[nodiscard]] const octomap::OcTree& tree() const { return map_.tree(); }
  [[nodiscard]] bool knows(const Eigen::Vector3d& at) const {
    return tree().search(rounded(at)) != nullptr;
  }
  [[nodiscard]] double log_odds(const Eigen::Vector3d& at) const {
    const octomap::OcTreeNode* node = tree().search(rounded(at));
    return node == nullptr ? -99.0 : node->getLogOdds();
  }
  [[nodiscard]] bool is_free(const Eigen::Vector3d& at) const {
    return knows(at) && log_odds(at) < 0.0;
  }

 private:
  Parameters parameters_;
  OccupancyMap map_;
};

}  // namespace raymoval::octomap_test
