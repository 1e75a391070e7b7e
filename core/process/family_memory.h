// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <chrono>
#include <ctime>
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

/// The time as file systems note it.
timespec file_clock();

/// Measures the memory of a family of processes again and again, at little cost.
///
/// This is the memory that the system would regain if the family ended, without files on a disk.
/// Memory that processes share, after a fork or through shared memory, counts once (the sum of
/// Pss_Anon and Pss_Shmem). Files in a file system without a disk (/dev/shm, memfd) also count once
/// if the family has them open without mapping them and they were written since the family began.
/// Such a file does not count if it is neither open nor mapped, because its owner is then unknown.
///
/// The system computes shares by a walk through all pages. So they are only read if the sum of
/// RssAnon and RssShmem of all processes, which is never less, exceeds the limit.
class FamilyMemory {
 public:
  /// @param limit_mib 0 means that there is none
  explicit FamilyMemory(double limit_mib, timespec (*clock)() = file_clock);

  /// The memory of these processes in MiB. It is exact if it exceeds the limit; else it may be more
  /// than their memory.
  [[nodiscard]] double measure(const std::vector<pid_t>& members);

  /// Whether the shares of a process could not be read (/proc/PID/smaps_rollup), so that shared
  /// memory counts for each process.
  [[nodiscard]] bool counts_shares_in_full() const { return counts_shares_in_full_; }

 private:
  void follow_clock();
  [[nodiscard]] double proportional_mib(const std::vector<pid_t>& members);
  [[nodiscard]] double unmapped_files_mib(const std::vector<pid_t>& members) const;

  double limit_mib_;
  timespec (*clock_)();
  timespec began_;  ///< Files that were written before are not the family's.
  Pace::Clock::time_point last_look_ = Pace::Clock::now();
  Pace share_pace_, file_pace_;
  double files_mib_ = 0.0;
  double last_share_mib_ = 0.0, sum_then_mib_ = 0.0;  ///< Of the last measurement of shares.
  bool counts_shares_in_full_ = false;
};

}  // namespace raymoval
