// SPDX-License-Identifier: MIT
#pragma once

#include <random>
#include <string>
#include <vector>

#include "methods/peopleremover/parameters.h"
#include "methods/registry.h"
#include "tests/methods/toy_world.h"

namespace raymoval::toy {

/// Scans given point by point.
class ListedScans : public ScanSource {
 public:
  /// Appends a scan of world points (rounded to the sensor frame's single precision).
  ListedScans& scan(const Pose& T_world_sensor, const std::vector<Eigen::Vector3d>& world) {
    Scan scan;
    scan.index = scans_.size();
    scan.T_world_sensor = T_world_sensor;
    for (const auto& point : world) {
      scan.points.emplace_back((T_world_sensor.inverse() * point).cast<float>());
    }
    scan.stored_point_count = scan.size();
    scans_.push_back(scan);
    return *this;
  }
  /// Appends a scan of points (X, 0.5, 0.5) seen from (0.5, 0.5, 0.5).
  ListedScans& row(const std::vector<double>& xs) {
    std::vector<Eigen::Vector3d> world;
    for (const double x : xs) world.emplace_back(x, 0.5, 0.5);
    return scan(at(0.5, 0.5, 0.5), world);
  }
  static Pose at(double x, double y, double z) {
    Pose pose = Pose::Identity();
    pose.translation() << x, y, z;
    return pose;
  }

  [[nodiscard]] std::size_t size() const override { return scans_.size(); }
  [[nodiscard]] Scan load(std::size_t i) const override { return scans_.at(i); }
  [[nodiscard]] Pose pose(std::size_t i) const override { return scans_.at(i).T_world_sensor; }
  [[nodiscard]] const SensorModel& sensor() const override { return model_; }

 private:
  std::vector<Scan> scans_;
  SensorModel model_;
};

/// A configured Peopleremover with some values changed.
inline ConfiguredMethod peopleremover(const std::string& variant, const Configuration& changes) {
  auto method = MethodRegistry::built_in().configure("peopleremover:" + variant);
  for (const auto& [name, value] : changes) set_parameter(method.configuration, name, value);
  return method;
}

}  // namespace raymoval::toy
