// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <vector>

#include "methods/raymoval_plus/objects/objects.h"

namespace raymoval::raymoval_plus_method {

/// The scans that wait for their answer. Each is answered a fixed time after it came, from the
/// scans that came up to then. The clock is the latest time of a scan so far: it never goes back,
/// and the scans of one moment wait equally long.
class WaitingScans {
 public:
  /// @param delay seconds from a scan to its answer; 0 to answer it at once
  explicit WaitingScans(double delay) : delay_(delay) {}

  /// The clock shows at least this time.
  void tick(double time_s);
  /// A scan to be filled, which comes now and waits behind the others. Its memory was another's.
  /// @throws DataError if too many scans wait: their times are wrong, or the delay is too long for
  ///   so fast a sensor
  SegmentedScan& add();
  /// Whether the time of the first scan's answer has come.
  [[nodiscard]] bool is_due() const;
  /// Whether it has passed, so that the scan that comes now is too late for it.
  [[nodiscard]] bool is_overdue() const;
  [[nodiscard]] bool empty() const { return waiting_.empty(); }
  [[nodiscard]] SegmentedScan& first() { return *waiting_.front().scan; }
  /// Takes the first scan away, and keeps its memory for another one.
  void remove_first();

 private:
  struct Waiting {
    double since;  ///< Seconds.
    std::unique_ptr<SegmentedScan> scan;
  };
  double delay_;
  double clock_ = 0.0;
  bool has_clock_ = false;
  std::deque<Waiting> waiting_;
  std::vector<std::unique_ptr<SegmentedScan>> spare_;
};

}  // namespace raymoval::raymoval_plus_method
