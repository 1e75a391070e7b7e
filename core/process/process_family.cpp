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
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>
#include <thread>

#include "core/process/proc_files.h"
#include "core/text.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

constexpr auto kMostPatience = std::chrono::seconds(2);

fs::path proc_folder(pid_t process) {
  return fmt::format("/proc/{}", process);
}

/// The entries of a folder, as far as they can be read: processes end while they are looked at.
std::vector<fs::path> entries_now(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error); !error && entry != fs::directory_iterator();
       entry.increment(error)) {
    entries.push_back(entry->path());
  }
  return entries;
}

std::vector<pid_t> children_of(pid_t process) {
  std::vector<pid_t> children;
  for (const fs::path& thread : entries_now(proc_folder(process) / "task")) {
    std::ifstream file(thread / "children");
    for (pid_t child = 0; file >> child;) children.push_back(child);
  }
  return children;
}

struct ProcessState {
  char letter = 'X';  ///< As in /proc/PID/stat: 'Z' is a zombie, 'X' is gone.
  pid_t session = 0;

  [[nodiscard]] bool has_ended() const { return letter == 'Z' || letter == 'X'; }
};

ProcessState state_of(pid_t process) {
  std::ifstream file(proc_folder(process) / "stat");
  std::string text;
  std::getline(file, text, '\0');
  ProcessState state;
  // The name of the program stands in parentheses and may hold blanks and parentheses itself.
  const std::size_t name_end = text.rfind(')');
  if (name_end == std::string::npos) return state;
  std::istringstream fields(text.substr(name_end + 1));
  pid_t parent = 0, group = 0;
  fields >> state.letter >> parent >> group >> state.session;
  return state;
}

/// `process` and its descendants; with `stop` each is stopped before its children are looked for.
void add_with_descendants(pid_t process, bool stop, std::vector<pid_t>& found) {
  if (std::find(found.begin(), found.end(), process) != found.end()) return;
  found.push_back(process);
  if (stop && process != ::getpid()) ::kill(process, SIGSTOP);
  for (const pid_t child : children_of(process)) add_with_descendants(child, stop, found);
}

sem_t parent_ended;

void on_parent_ended(int) {
  ::sem_post(&parent_ended);
}

/// Waits for the end of the parent. It runs as a thread of its own, since a signal's handler may do
/// next to nothing.
void wait_for_parent_and_end() {
  while (::sem_wait(&parent_ended) != 0) continue;
  const char* marks = std::getenv(kFamilyVariable);
  const std::string text = marks != nullptr ? marks : "";
  ProcessFamily(::getpid(), text.substr(text.rfind(' ') + 1)).end();
}

}  // namespace

double ProcessFamily::memory_mib() const {
  std::vector<pid_t> members;
  add_with_descendants(head_, false, members);
  double mib = 0.0;
  for (const pid_t process : members) {
    const fs::path status = proc_folder(process) / "status";
    for (const char* key : {"RssAnon", "RssShmem"}) mib += proc_mib(status, key).value_or(0.0);
  }
  return mib;
}

bool ProcessFamily::is_member(pid_t process) const {
  const ProcessState state = state_of(process);
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

/// All members that have not ended, without the head, each of them stopped.
std::vector<pid_t> ProcessFamily::stopped_members() const {
  std::vector<pid_t> members;
  add_with_descendants(head_, true, members);
  for (const fs::path& entry : entries_now("/proc")) {
    const auto process = parse_number<pid_t>(entry.filename().string());
    if (process && is_member(*process)) add_with_descendants(*process, true, members);
  }
  std::erase_if(members,
                [&](pid_t process) { return process == head_ || state_of(process).has_ended(); });
  return members;
}

void ProcessFamily::end() const {
  const auto started = std::chrono::steady_clock::now();
  do {
    const std::vector<pid_t> members = stopped_members();
    if (members.empty()) break;
    for (const pid_t process : members) ::kill(process, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  } while (std::chrono::steady_clock::now() - started < kMostPatience);
  ::kill(-head_, SIGKILL);  // The process group of the head: at once, whatever it does meanwhile.
  ::kill(head_, SIGKILL);
}

void end_family_with_parent() {
  ::sem_init(&parent_ended, 0, 0);
  std::thread(wait_for_parent_and_end).detach();
  std::signal(SIGTERM, on_parent_ended);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
}

}  // namespace raymoval
