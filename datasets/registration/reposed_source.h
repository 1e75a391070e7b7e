// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/scan/scan_source.h"

namespace raymoval {

/// The scans of another source under other poses.
class ReposedSource : public DerivedSource {
 public:
  /// @param poses one for each scan
  ReposedSource(std::shared_ptr<const ScanSource> whole, std::vector<Pose> poses)
      : DerivedSource(std::move(whole)), poses_(std::move(poses)) {}

  [[nodiscard]] Pose pose(std::size_t index) const override { return poses_.at(index); }
  [[nodiscard]] Scan load(std::size_t index) const override {
    Scan scan = whole_->load(index);
    scan.T_world_sensor = pose(index);
    return scan;
  }

 private:
  std::vector<Pose> poses_;
};

}  // namespace raymoval
