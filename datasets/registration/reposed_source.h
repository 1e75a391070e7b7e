// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/scan/scan_source.h"

namespace raymoval {

/// The scans of another source under other poses.
class ReposedSource : public ScanSource {
 public:
  /// @param poses one for each scan
  ReposedSource(std::shared_ptr<const ScanSource> whole, std::vector<Pose> poses)
      : whole_(std::move(whole)), poses_(std::move(poses)) {}

  [[nodiscard]] std::size_t size() const override { return whole_->size(); }
  [[nodiscard]] Pose pose(std::size_t index) const override { return poses_.at(index); }
  [[nodiscard]] Scan load(std::size_t index) const override {
    Scan scan = whole_->load(index);
    scan.T_world_sensor = pose(index);
    return scan;
  }
  [[nodiscard]] const SensorModel& sensor() const override { return whole_->sensor(); }

  [[nodiscard]] const ScanSource& whole() const { return *whole_; }

 private:
  std::shared_ptr<const ScanSource> whole_;
  std::vector<Pose> poses_;
};

}  // namespace raymoval
