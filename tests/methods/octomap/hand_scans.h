// SPDX-License-Identifier: MIT
#pragma once

#include <octomap/OcTree.h>

#include <sstream>
#include <string>
#include <vector>

#include "methods/octomap/occupancy_tree.h"
#include "methods/octomap/scan_cells.h"
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

/// The map alone, a scan at a time.
class HandMap {
 public:
  explicit HandMap(const Parameters& parameters, int threads = 1)
      : parameters_(parameters),
        context_{.threads = threads},
        cells_(parameters_, context_),
        map_(parameters_) {}
  HandMap(const HandMap&) = delete;
  HandMap& operator=(const HandMap&) = delete;

  HandMap& insert(const Points& points, const Eigen::Vector3d& origin = {0.1, 0.1, 0.1},
                  PointRole role = PointRole::kSurface) {
    cells_.compute(rounded(points), std::vector<PointRole>(points.size(), role), rounded(origin));
    map_.update(cells_.parts());
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
  RunContext context_;
  ScanCells cells_;
  OccupancyTree map_;
};

/// Every node of a tree with its value, and what it consists of.
inline std::string tree_bytes(const octomap::OcTree& tree) {
  std::ostringstream bytes;
  tree.write(bytes);
  return bytes.str();
}

}  // namespace raymoval::octomap_test
