// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace raymoval {

/// Wall time of a method by named stage and by scan. Thread-safe; stages keep the order in which
/// they first ran.
class StageTimes {
 public:
  struct Stage {
    std::string name;
    double seconds = 0.0;
  };
  void add(const std::string& stage, double seconds);
  void add_scan(std::size_t scan, double seconds);
  [[nodiscard]] std::vector<Stage> stages() const;
  /// Seconds spent on each scan, in order of scan; several passes over one scan add up.
  [[nodiscard]] std::vector<double> seconds_by_scan() const;

 private:
  mutable std::mutex mutex_;
  std::vector<Stage> stages_;
  std::map<std::size_t, double> by_scan_;
};

/// Adds the time from its construction to its end to a stage. `StageScope s(times, "binning");`
class StageScope {
 public:
  StageScope(StageTimes* times, const char* stage) : times_(times), stage_(stage) {}
  ~StageScope() {
    if (times_ != nullptr) times_->add(stage_, elapsed());
  }
  StageScope(const StageScope&) = delete;
  StageScope& operator=(const StageScope&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  [[nodiscard]] double elapsed() const {
    return std::chrono::duration<double>(Clock::now() - started_).count();
  }
  StageTimes* times_;
  const char* stage_;
  Clock::time_point started_ = Clock::now();
};

/// Adds the time from its construction to its end to a scan.
class ScanScope {
 public:
  ScanScope(StageTimes* times, std::size_t scan) : times_(times), scan_(scan) {}
  ~ScanScope() {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started_;
    if (times_ != nullptr) times_->add_scan(scan_, elapsed.count());
  }
  ScanScope(const ScanScope&) = delete;
  ScanScope& operator=(const ScanScope&) = delete;

 private:
  StageTimes* times_;
  std::size_t scan_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

}  // namespace raymoval
