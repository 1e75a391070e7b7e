// SPDX-License-Identifier: MIT
#pragma once

#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "core/scan/scan_source.h"

namespace raymoval {

/// Hands on the scans of a source. It measures the time that reading them takes, so that a method's
/// own time can be told from that of the disk, and it keeps the number of points of each scan.
class TimedSource : public ScanSource {
 public:
  /// The calling thread becomes the owner: the time that it waits is not counted as the method's.
  explicit TimedSource(const ScanSource& source)
      : source_(source), owner_(std::this_thread::get_id()), counts_(source.size()) {}
  [[nodiscard]] std::size_t size() const override { return source_.size(); }
  [[nodiscard]] Scan load(std::size_t index) const override;
  [[nodiscard]] Pose pose(std::size_t index) const override { return source_.pose(index); }
  [[nodiscard]] const SensorModel& sensor() const override { return source_.sensor(); }

  /// The seconds that the owning thread has spent in `load`.
  [[nodiscard]] double waited_seconds() const;
  /// The number of points of scan `index`. Reads the scan only if nobody has read it yet.
  [[nodiscard]] std::size_t point_count(std::size_t index) const;

 private:
  const ScanSource& source_;
  std::thread::id owner_;
  mutable std::mutex mutex_;
  mutable double waited_ = 0.0;
  mutable std::vector<std::optional<std::size_t>> counts_;
};

}  // namespace raymoval
