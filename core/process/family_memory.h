// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <chrono>
#include <vector>

namespace raymoval {

/// Limits how often a slow measurement is repeated.
class Pace {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param rest at least this time is left between two measurements, and ten times the duration of
  /// the last one
  explicit Pace(std::chrono::milliseconds rest) : rest_(rest) {}

  [[nodiscard]] bool is_due() const { return Clock::now() >= next_; }
  /// Whether it may be measured early, for a good reason.
  [[nodiscard]] bool may_hurry() const { return Clock::now() >= earliest_; }
  void begin() { begun_ = Clock::now(); }
  void end();

 private:
  std::chrono::milliseconds rest_;
  Clock::time_point begun_, next_, earliest_;
};

/// Measures the memory of a family of processes again and again, at little cost.
///
/// This is the memory that the system would regain if the family ended, without files. Memory that
/// processes share, after a fork or through shared memory, counts once (the sum of Pss_Anon and
/// Pss_Shmem).
///
/// The system computes shares by a walk through all pages. So they are only read if the sum of
/// RssAnon and RssShmem of all processes, which is never less, exceeds the limit.
class FamilyMemory {
 public:
  /// @param limit_mib 0 means that there is none
  explicit FamilyMemory(double limit_mib) : limit_mib_(limit_mib) {}

  /// The memory of these processes in MiB. It is exact if it exceeds the limit; else it may be more
  /// than their memory.
  [[nodiscard]] double measure(const std::vector<pid_t>& members);

  /// Whether the shares of a process could not be read (/proc/PID/smaps_rollup), so that shared
  /// memory counts for each process.
  [[nodiscard]] bool counts_shares_in_full() const { return counts_shares_in_full_; }

 private:
  [[nodiscard]] double proportional_mib(const std::vector<pid_t>& members);

  double limit_mib_;
  Pace share_pace_{std::chrono::milliseconds(20)};
  double last_share_mib_ = 0.0, sum_then_mib_ = 0.0;  ///< Of the last measurement of shares.
  bool counts_shares_in_full_ = false;
};

}  // namespace raymoval
