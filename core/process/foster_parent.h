// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <vector>

namespace raymoval {

/// While one of these lives, this process is the foster parent of all below it whose own parent
/// ends (PR_SET_CHILD_SUBREAPER): what a child leaves behind when it ends comes here and not to the
/// system's first process, where nobody could find it.
///
/// This process may have children that have nothing to do with it: those of other threads, of a
/// program that uses this library, and what these leave behind. They are never waited for or
/// ended. A child of a family is told from them by its oom_score_adj, which heads of families are
/// given, which descendants inherit, and which only the system's administrator can take back.
class FosterParent {
 public:
  FosterParent();
  ~FosterParent();
  FosterParent(const FosterParent&) = delete;
  FosterParent& operator=(const FosterParent&) = delete;

  /// The oom_score_adj of the head that is to be started, which is more than this process's own. It
  /// also lets the system end the child and not this process when memory runs out.
  [[nodiscard]] int score() const { return score_; }

  /// Says that this child is a head and no foster child.
  void set_head(pid_t head);

  /// The foster children. Those that have ended are waited for, so that they are found only once.
  /// Which family they are of cannot be told, so there are none as long as another family runs too:
  /// the last one ends them.
  [[nodiscard]] std::vector<pid_t> foster_children() const;

 private:
  int score_;
  pid_t head_ = -1;
};

}  // namespace raymoval
