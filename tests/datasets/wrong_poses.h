// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <utility>

#include "datasets/simulation/street/street.h"

namespace raymoval::test {

/// The exact street, whose sensor moves 1 m per scan, with poses with an error in their position.
class WrongPoses : public ScanSource {
 public:
  explicit WrongPoses(std::function<Eigen::Vector3d(std::size_t)> error,
                      const SequenceOptions& options = {})
      : sequence_(make_street({}, street_boxes(), options)), error_(std::move(error)) {}

  [[nodiscard]] std::size_t size() const override { return sequence_.scans->size(); }
  [[nodiscard]] Pose pose(std::size_t index) const override {
    Pose pose = sequence_.scans->pose(index);
    pose.translation() += error_(index);
    return pose;
  }
  [[nodiscard]] Scan load(std::size_t index) const override {
    Scan scan = sequence_.scans->load(index);
    scan.T_world_sensor = pose(index);
    return scan;
  }
  [[nodiscard]] const SensorModel& sensor() const override { return sequence_.scans->sensor(); }

 private:
  Sequence sequence_;
  std::function<Eigen::Vector3d(std::size_t)> error_;
};

}  // namespace raymoval::test
