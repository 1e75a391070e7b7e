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

double resident_mib(pid_t process) {
  return proc_mib_sum(proc_folder(process) / "status", {"RssAnon", "RssShmem"}).value_or(0.0);
}

constexpr auto kMostPatience = std::chrono::seconds(2);
constexpr auto kPatienceWithHead = std::chrono::milliseconds(50);

void add_with_descendants(pid_t process, std::vector<pid_t>& found) {
  if (std::find(found.begin(), found.end(), process) != found.end()) return;
  found.push_back(process);
  for (const pid_t child : children_of(process)) add_with_descendants(child, found);
}

/// The mark of the family whose head this process is, if it is one.
std::string innermost_mark() {
  const char* marks = std::getenv(kFamilyVariable);
  const std::string text = marks != nullptr ? marks : "";
  return text.substr(text.rfind(' ') + 1);
}

/// The signal at the end of the parent. No other process sends this signal.
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

void Pace::end() {
  const Clock::time_point now = Clock::now();
  const auto took = now - begun_;
  earliest_ = now + took;
  next_ = now + std::max<Clock::duration>(rest_, 10 * took);
}

double FamilyMemory::measure(const std::vector<pid_t>& members) {
  double sum = 0.0;
  for (const pid_t process : members) sum += resident_mib(process);
  if (limit_mib_ <= 0.0 || sum <= limit_mib_) return sum;
  const double estimate = last_share_mib_ + std::max(0.0, sum - sum_then_mib_);
  if (share_pace_.is_due() || (estimate > limit_mib_ && share_pace_.may_hurry())) {
    share_pace_.begin();
    last_share_mib_ = proportional_mib(members);
    sum_then_mib_ = sum;
    share_pace_.end();
    return last_share_mib_;
  }
  return std::min(estimate, limit_mib_);  // No limit is exceeded by an estimate.
}

double FamilyMemory::proportional_mib(const std::vector<pid_t>& members) {
  double mib = 0.0;
  for (const pid_t process : members) {
    const auto share =
        proc_mib_sum(proc_folder(process) / "smaps_rollup", {"Pss_Anon", "Pss_Shmem"});
    const double in_full = share ? 0.0 : resident_mib(process);
    counts_shares_in_full_ = counts_shares_in_full_ || in_full > 0.0;
    mib += share.value_or(in_full);
  }
  return mib;
}

std::vector<pid_t> ProcessFamily::members() const {
  std::vector<pid_t> members;
  add_with_descendants(head_, members);
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

ProcessFamily::Members ProcessFamily::found_members() const {
  std::vector<pid_t> found;
  add_with_descendants(head_, found);
  for (const pid_t process : all_processes()) {
    if (is_member(process)) add_with_descendants(process, found);
  }
  if (foster_ != nullptr) {
    for (const pid_t child : foster_->adopted_children()) add_with_descendants(child, found);
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
  for (bool has_head = true;;) {
    const Members members = found_members();
    for (const pid_t process : members.living) ::kill(process, SIGKILL);
    bool quiet = members.living.empty();
    // A member that has ended since the last search may have started another process after it.
    for (const pid_t process : members.ended) quiet &= !known_ended.insert(process).second;
    const auto took = std::chrono::steady_clock::now() - started;
    if (has_head && (quiet || took > kPatienceWithHead)) {
      ::kill(-head_, SIGKILL);  // Its whole process group at once.
      ::kill(head_, SIGKILL);
      has_head = false;
    } else if (quiet || took > kMostPatience) {
      return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
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
