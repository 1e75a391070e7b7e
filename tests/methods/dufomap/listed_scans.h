// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/scan/scan_source.h"

namespace raymoval::dufomap_test {

/// Scans given point by point in world coordinates.
class ListedScans : public ScanSource {
 public:
  void add(const Eigen::Vector3d& sensor, const std::vector<Eigen::Vector3d>& world_points) {
    Scan scan;
    scan.index = scans_.size();
    scan.name = std::to_string(scan.index);
    scan.T_world_sensor.translation() = sensor;
    for (const Eigen::Vector3d& point : world_points) {
      scan.points.push_back((point - sensor).cast<float>());
    }
    scan.stored_point_count = scan.size();
    scans_.push_back(scan);
  }
  [[nodiscard]] std::size_t size() const override { return scans_.size(); }
  [[nodiscard]] Scan load(std::size_t i) const override { return scans_.at(i); }
  [[nodiscard]] Pose pose(std::size_t i) const override { return scans_.at(i).T_world_sensor; }
  [[nodiscard]] const SensorModel& sensor() const override { return model_; }

 private:
  std::vector<Scan> scans_;
  SensorModel model_;
};

/// Centre of a voxel of 0.1 m.
inline Eigen::Vector3d centre(int x, int y, int z) {
  return Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5) * 0.1;
}

}  // namespace raymoval::dufomap_test
