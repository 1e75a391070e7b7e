// SPDX-License-Identifier: MIT
#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/scan/scan_source.h"

namespace raymoval {

/// The contract of an online method: it loads each scan once, and gives the mask of scan t before
/// it loads a scan that is more than `delay_s` later. The check is exact with one thread. With N
/// threads a method may hold two batches of N scans (see methods/common/prepared_scans.h).
struct OnlineRule {
  std::string method;  ///< For messages.
  double delay_s = 0.0;
  int threads = 1;
};

/// Passes on the scans of a source. It measures the reading time, so that it can be subtracted from
/// a method's time, and stores the number of points of each scan.
class TimedSource : public ScanSource {
 public:
  /// The calling thread becomes the owner: the time that it waits is not counted as the method's.
  /// @param rule of the method that reads; no value if it is offline
  explicit TimedSource(const ScanSource& source, std::optional<OnlineRule> rule = std::nullopt)
      : source_(source),
        owner_(std::this_thread::get_id()),
        rule_(std::move(rule)),
        counts_(source.size()),
        times_(source.size()) {}
  [[nodiscard]] std::size_t size() const override { return source_.size(); }
  /// @throws MethodError if an online method loads a scan twice
  [[nodiscard]] Scan load(std::size_t index) const override;
  [[nodiscard]] Pose pose(std::size_t index) const override { return source_.pose(index); }
  [[nodiscard]] const SensorModel& sensor() const override { return source_.sensor(); }

  /// The seconds that the owning thread has spent in `load`.
  [[nodiscard]] double waited_seconds() const;
  /// The number of points of scan `index`. Reads the scan only if it was not read yet.
  [[nodiscard]] std::size_t point_count(std::size_t index) const;
  /// @throws MethodError if an online method gives the mask of scan `index` too late
  void check_in_time(std::size_t index) const;

 private:
  const ScanSource& source_;
  std::thread::id owner_;
  std::optional<OnlineRule> rule_;
  mutable std::mutex mutex_;
  mutable double waited_ = 0.0;
  mutable std::vector<std::optional<std::size_t>> counts_;
  mutable std::vector<std::optional<double>> times_;  ///< Of the loaded scans.
  mutable std::size_t end_ = 0;                       ///< One after the last of these.
};

}  // namespace raymoval
