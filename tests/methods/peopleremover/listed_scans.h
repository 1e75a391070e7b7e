// SPDX-License-Identifier: MIT
#pragma once

#include <random>
#include <string>
#include <vector>

#include "methods/peopleremover/peopleremover.h"
#include "methods/registry.h"
#include "tests/methods/toy_world.h"

namespace raymoval::peopleremover_test {

using namespace toy;

/// Scans given point by point.
class ListedScans : public HeldScans {
 public:
  /// Appends a scan of world points.
  ListedScans& scan(const Pose& T_world_sensor, const std::vector<Eigen::Vector3d>& world) {
    add_world(T_world_sensor, world);
    return *this;
  }
  /// Appends a scan of points (X, 0.5, 0.5) seen from (0.5, 0.5, 0.5).
  ListedScans& row(const std::vector<double>& xs) {
    std::vector<Eigen::Vector3d> world;
    for (const double x : xs) world.emplace_back(x, 0.5, 0.5);
    return scan(pose_at(0.5, 0.5, 0.5), world);
  }
};

/// A configured Peopleremover with some values changed.
inline ConfiguredMethod peopleremover(const std::string& variant, const Configuration& changes) {
  auto method = MethodRegistry::built_in().configure("peopleremover:" + variant);
  for (const auto& [name, value] : changes) set_parameter(method.configuration, name, value);
  return method;
}

}  // namespace raymoval::peopleremover_test
