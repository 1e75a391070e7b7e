// SPDX-License-Identifier: MIT
#include "core/process/process_family.h"

#include <fmt/format.h>
#include <semaphore.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <set>
#include <thread>

#include "core/process/proc_files.h"
#include "core/text.h"

namespace raymoval {
namespace {

constexpr auto kMostPatience = std::chrono::seconds(2);

/// `process` and its descendants; with `stop` each is stopped before its children are looked for.
void add_with_descendants(pid_t process, bool stop, std::vector<pid_t>& found) {
  if (std::find(found.begin(), found.end(), process) != found.end()) return;
  found.push_back(process);
  if (stop && process != ::getpid()) ::kill(process, SIGSTOP);
  for (const pid_t child : children_of(process)) add_with_descendants(child, stop, found);
}

/// The mark of the family whose head this process is, if it is one.
std::string innermost_mark() {
  const char* marks = std::getenv(kFamilyVariable);
  const std::string text = marks != nullptr ? marks : "";
  return text.substr(text.rfind(' ') + 1);
}

/// What tells this process the end of its parent: no signal that anybody else sends.
int parent_signal() {
  return SIGRTMIN;
}

sem_t parent_ended;

void on_parent_ended(int) {
  ::sem_post(&parent_ended);
}

/// Waits for the end of the parent. It runs as a thread of its own, since a signal's handler may do
/// next to nothing.
void wait_for_parent_and_end() {
  while (::sem_wait(&parent_ended) != 0) continue;
  ProcessFamily(::getpid(), innermost_mark(), nullptr).end();
}

}  // namespace

std::vector<pid_t> ProcessFamily::members() const {
  std::vector<pid_t> members;
  add_with_descendants(head_, false, members);
  return members;
}

bool ProcessFamily::is_member(pid_t process) const {
  const ProcessState state = process_state(process);
  if (state.has_ended()) return false;
  if (state.session == head_) return true;
  std::ifstream file(proc_folder(process) / "environ");
  for (std::string entry; !mark_.empty() && std::getline(file, entry, '\0');) {
    if (!entry.starts_with(std::string(kFamilyVariable) + "=")) continue;
    const auto marks = split_blanks(std::string_view(entry).substr(entry.find('=') + 1));
    return std::find(marks.begin(), marks.end(), mark_) != marks.end();
  }
  return false;
}

ProcessFamily::Members ProcessFamily::stopped_members() const {
  std::vector<pid_t> found;
  add_with_descendants(head_, true, found);
  for (const pid_t process : all_processes()) {
    if (is_member(process)) add_with_descendants(process, true, found);
  }
  if (foster_ != nullptr) {
    for (const pid_t child : foster_->foster_children()) add_with_descendants(child, true, found);
  }
  Members members;
  for (const pid_t process : found) {
    if (process == head_) continue;
    (process_state(process).has_ended() ? members.ended : members.living).push_back(process);
  }
  return members;
}

void ProcessFamily::end() const {
  const auto started = std::chrono::steady_clock::now();
  std::set<pid_t> known_ended;
  do {
    const Members members = stopped_members();
    bool quiet = members.living.empty();
    // Who has ended since the last look may have started another one after it was looked for.
    for (const pid_t process : members.ended) quiet &= !known_ended.insert(process).second;
    if (quiet) break;
    for (const pid_t process : members.living) ::kill(process, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  } while (std::chrono::steady_clock::now() - started < kMostPatience);
  ::kill(-head_, SIGKILL);  // The process group of the head: at once, whatever it does meanwhile.
  ::kill(head_, SIGKILL);
}

bool is_family_head() {
  return innermost_mark().starts_with(fmt::format("{}-", ::getppid()));
}

void end_family_with_parent() {
  ::sem_init(&parent_ended, 0, 0);
  std::thread(wait_for_parent_and_end).detach();
  std::signal(parent_signal(), on_parent_ended);
  ::prctl(PR_SET_PDEATHSIG, parent_signal());
}

}  // namespace raymoval
