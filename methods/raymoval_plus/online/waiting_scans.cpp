// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/online/waiting_scans.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.h"

namespace raymoval::raymoval_plus_method {
namespace {

/// Times are read from decimal numbers: a tenth of a second ten times over is to be a second.
constexpr double kTimeRounding = 1e-6;
/// With more scans the memory would fill: large ones take some 10 MB each.
constexpr std::size_t kMostWaiting = 256;

}  // namespace

void WaitingScans::tick(double time_s) {
  clock_ = has_clock_ ? std::max(clock_, time_s) : time_s;
  has_clock_ = true;
}

SegmentedScan& WaitingScans::add() {
  if (waiting_.size() >= kMostWaiting) {
    throw DataError(fmt::format(
        "{} scans came within the delay of {} s, the last at {} s, and no more can wait for their "
        "answers. If the sensor is so fast, set a shorter delay. If it is not, the times are "
        "wrong: check that they go on from scan to scan in times.txt, or \"scan_period_s\", or set "
        "delay to 0.",
        kMostWaiting, delay_, clock_));
  }
  std::unique_ptr<SegmentedScan> scan = std::make_unique<SegmentedScan>();
  if (!spare_.empty()) {
    scan = std::move(spare_.back());
    spare_.pop_back();
  }
  waiting_.push_back({clock_, std::move(scan)});
  return *waiting_.back().scan;
}

bool WaitingScans::is_due() const {
  return !waiting_.empty() && clock_ >= waiting_.front().since + delay_ - kTimeRounding;
}

bool WaitingScans::is_overdue() const {
  return !waiting_.empty() && clock_ > waiting_.front().since + delay_ + kTimeRounding;
}

void WaitingScans::remove_first() {
  spare_.push_back(std::move(waiting_.front().scan));
  waiting_.pop_front();
}

}  // namespace raymoval::raymoval_plus_method
