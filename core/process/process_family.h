// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <string>
#include <utility>
#include <vector>

#include "core/process/subreaper_scope.h"

namespace raymoval {

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
