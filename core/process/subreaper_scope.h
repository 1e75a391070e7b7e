// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <vector>

namespace raymoval {

/// While an object of this class lives, this process is the foster parent of its descendants whose
/// parent ends (PR_SET_CHILD_SUBREAPER). Processes that a child leaves behind then become children
/// of this process, where they can be found, and not of the system's first process.
///
/// This process may have other children: children of other threads or of a program that uses this
/// library, and processes that these left behind. They are never waited for or ended. A child of a
/// family is recognised by its oom_score_adj. Heads of families get it, descendants inherit it, and
/// only the system's administrator can lower it.
class SubreaperScope {
 public:
  SubreaperScope();
  ~SubreaperScope();
  SubreaperScope(const SubreaperScope&) = delete;
  SubreaperScope& operator=(const SubreaperScope&) = delete;

  /// The oom_score_adj of the head that is to be started, which is more than this process's own. It
  /// also lets the system end the child and not this process when memory runs out.
  [[nodiscard]] int score() const { return score_; }

  /// Notes that this child is a head and no foster child.
  void set_head(pid_t head);

  /// The foster children. Ended foster children are waited for, so that they are found only once.
  /// Their family is unknown, so the list is empty as long as another family runs, too: the last
  /// family ends them.
  [[nodiscard]] std::vector<pid_t> adopted_children() const;

 private:
  int score_;
  pid_t head_ = -1;
};

}  // namespace raymoval
