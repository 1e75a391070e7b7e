// SPDX-License-Identifier: MIT
#include "core/process/subreaper_scope.h"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <mutex>
#include <set>

#include "core/process/proc_files.h"

namespace raymoval {
namespace {

constexpr int kUsualScore = 800;
constexpr int kHighestScore = 1000;

/// The families that run below this process.
struct Families {
  std::mutex mutex;
  int count = 0;
  int was_subreaper = 0;  ///< Whether this process was one before the first family.
  std::set<pid_t> heads;
};

Families& families() {
  static auto* all = new Families;  // Never destroyed: threads may outlive the end of main.
  return *all;
}

int score_of(const std::filesystem::path& process) {
  int score = 0;
  std::ifstream(process / "oom_score_adj") >> score;
  return score;
}

}  // namespace

SubreaperScope::SubreaperScope()
    : score_(std::min(kHighestScore, std::max(kUsualScore, score_of("/proc/self") + 1))) {
  Families& all = families();
  const std::lock_guard lock(all.mutex);
  if (all.count++ > 0) return;
  ::prctl(PR_GET_CHILD_SUBREAPER, &all.was_subreaper);
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
}

SubreaperScope::~SubreaperScope() {
  Families& all = families();
  const std::lock_guard lock(all.mutex);
  all.heads.erase(head_);
  if (--all.count == 0) ::prctl(PR_SET_CHILD_SUBREAPER, all.was_subreaper);
}

void SubreaperScope::set_head(pid_t head) {
  Families& all = families();
  const std::lock_guard lock(all.mutex);
  head_ = head;
  all.heads.insert(head);
}

std::vector<pid_t> SubreaperScope::adopted_children() const {
  Families& all = families();
  const std::lock_guard lock(all.mutex);
  // A family is counted before its head starts, so that the head is not taken for a foster child.
  if (all.count > 1 || score_of("/proc/self") >= score_) return {};
  std::vector<pid_t> found;
  for (const pid_t child : children_of(::getpid())) {
    if (all.heads.count(child) > 0 || score_of(proc_folder(child)) < score_) continue;
    found.push_back(child);
    if (process_state(child).has_ended()) ::waitpid(child, nullptr, WNOHANG);
  }
  return found;
}

}  // namespace raymoval
