// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <string>
#include <utility>
#include <vector>

#include "core/process/foster_parent.h"

namespace raymoval {

/// The environment variable that identifies the members of a family. It holds the mark of each
/// family that a process belongs to.
inline constexpr const char* kFamilyVariable = "RAYMOVAL_PROCESS_FAMILY";

/// A process with all processes that it started, directly or through others.
///
/// Members are found in four ways, since each of them can be left: as descendants of the head, by
/// its session, by a mark in the environment that they inherit, and as foster children of this
/// process. As long as the head lives, it is itself the foster parent of what its descendants leave
/// behind (see `start_child`), so that double forks stay descendants; then this process is.
class ProcessFamily {
 public:
  /// @param head which has not been waited for, so that its number is not used again
  /// @param mark part of the variable `kFamilyVariable` of all members
  /// @param foster this process's; null if the head is this process
  ProcessFamily(pid_t head, std::string mark, const FosterParent* foster)
      : head_(head), mark_(std::move(mark)), foster_(foster) {}

  /// The head and its descendants.
  [[nodiscard]] std::vector<pid_t> members() const;

  /// Ends all members by SIGKILL, and looks for more until there is none left and none has ended
  /// meanwhile, so that a chain of members that each start the next one and end does not escape.
  /// The head comes last, since what its descendants leave behind is found below it. Nobody is
  /// stopped: if this process is killed meanwhile, a stopped head could not end its family (see
  /// `end_family_with_parent`). When this returns, the members have ended, but for those that the
  /// system itself holds up for more than two seconds.
  void end() const;

 private:
  /// Members without the head.
  struct Members {
    std::vector<pid_t> living;
    std::vector<pid_t> ended;  ///< Nobody has waited for them yet.
  };
  [[nodiscard]] Members found_members() const;
  [[nodiscard]] bool is_member(pid_t process) const;

  pid_t head_;
  std::string mark_;
  const FosterParent* foster_;
};

/// Whether `run_child` has started this process as a child of a process that still runs.
bool is_family_head();

/// From now on the end of the process that started this one ends this one, with all that it has
/// started. Until now it ended this process alone (see `run_child`), which has to be the head of a
/// family.
void end_family_with_parent();

}  // namespace raymoval
