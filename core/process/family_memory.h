// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <chrono>
#include <ctime>
#include <vector>

namespace raymoval {

/// Says when something may be looked at again that takes long to look at.
class Pace {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param rest at least this time is left between two looks, and ten times what the last one took
  explicit Pace(std::chrono::milliseconds rest) : rest_(rest) {}

  [[nodiscard]] bool is_due() const { return Clock::now() >= next_; }
  /// Whether it may be looked at before it is due, for a good reason.
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
/// Memory is what the system would have back if the family ended, without that of files on a disk:
/// what processes share, after a fork or through shared memory, counts once (the sum of Pss_Anon
/// and Pss_Shmem), and so do files in a file system without a disk (/dev/shm, memfd) that the
/// family holds open without mapping them and that were written since it began. Such a file counts
/// nothing when it is neither open nor mapped: nothing tells then whose it is.
///
/// The system counts shares by walking through all pages, so they are only looked at if the sum of
/// what each process has (RssAnon and RssShmem), which is never less, exceeds the limit.
class FamilyMemory {
 public:
  /// @param limit_mib 0 means that there is none
  explicit FamilyMemory(double limit_mib, timespec (*clock)() = file_clock);

  /// The memory of these processes in MiB. It is exact if it exceeds the limit; else it may be more
  /// than their memory.
  [[nodiscard]] double measure(const std::vector<pid_t>& members);

  /// Whether a process did not let its shares be read (/proc/PID/smaps_rollup), so that what it
  /// shares counts as often as it has it.
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
  double last_share_mib_ = 0.0, sum_then_mib_ = 0.0;  ///< Of the last look at shares.
  bool counts_shares_in_full_ = false;
};

}  // namespace raymoval
