// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "core/process/subreaper_scope.h"

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

/// The environment variable that identifies the members of a family. It holds the mark of each
/// family that a process belongs to.
inline constexpr const char* kFamilyVariable = "RAYMOVAL_PROCESS_FAMILY";

/// A process with all processes that it started, directly or through others.
///
/// Members are found in four ways, because a process can escape from each of them: as descendants
/// of the head, by its session, by a mark in the environment that they inherit, and as foster
/// children of this process. As long as the head lives, it is the foster parent of processes that
/// its descendants leave behind (see `start_child`), so that double forks stay descendants. After
/// the end of the head, this process is the foster parent.
class ProcessFamily {
 public:
  /// @param head which has not been waited for, so that its number is not used again
  /// @param mark part of the variable `kFamilyVariable` of all members
  /// @param foster this process's; null if the head is this process
  ProcessFamily(pid_t head, std::string mark, const SubreaperScope* foster)
      : head_(head), mark_(std::move(mark)), foster_(foster) {}

  /// The head and its descendants.
  [[nodiscard]] std::vector<pid_t> members() const;

  /// Ends all members by SIGKILL, and looks for more until there is none left and none has ended
  /// meanwhile, so that a chain of members that each start the next one and end does not escape.
  /// The head is ended last, because processes that its descendants leave behind are found below
  /// it. No process is stopped: if this process is killed meanwhile, a stopped head could not end
  /// its family (see `end_family_with_parent`). On return all members have ended, except processes
  /// that the system delays for more than two seconds.
  void end() const;

 private:
  /// Members without the head.
  struct Members {
    std::vector<pid_t> living;
    std::vector<pid_t> ended;  ///< They are not waited for yet.
  };
  [[nodiscard]] Members found_members() const;
  [[nodiscard]] bool is_member(pid_t process) const;

  pid_t head_;
  std::string mark_;
  const SubreaperScope* foster_;
};

/// Whether `run_child` has started this process as a child of a process that still runs.
bool is_family_head();

/// After this call, the end of the parent ends this process and all processes that it started.
/// Before, it ended this process alone (see `run_child`). This process must be the head of a
/// family.
void end_family_with_parent();

}  // namespace raymoval
