// SPDX-License-Identifier: MIT
#include "core/stage_timer.h"

namespace raymoval {

void StageTimes::add(const std::string& stage, double seconds) {
  const std::lock_guard lock(mutex_);
  for (Stage& known : stages_) {
    if (known.name == stage) {
      known.seconds += seconds;
      return;
    }
  }
  stages_.push_back({stage, seconds});
}

void StageTimes::add_scan(std::size_t scan, double seconds) {
  const std::lock_guard lock(mutex_);
  by_scan_[scan] += seconds;
}

std::vector<StageTimes::Stage> StageTimes::stages() const {
  const std::lock_guard lock(mutex_);
  return stages_;
}

std::vector<double> StageTimes::seconds_by_scan() const {
  const std::lock_guard lock(mutex_);
  std::vector<double> seconds;
  for (const auto& [scan, spent] : by_scan_) seconds.push_back(spent);
  return seconds;
}

}  // namespace raymoval
