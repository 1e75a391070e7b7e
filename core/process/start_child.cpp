// SPDX-License-Identifier: MIT
#include "core/process/start_child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <utility>

#include "core/process/process_family.h"

namespace raymoval {
namespace {

constexpr int kFirstSpare = 8;  ///< Above all descriptors that a child is given.

/// Both ends of a pipe; neither outlives an exec. They are not valid if the system refuses.
struct Pipe {
  Descriptor output, input;

  Pipe() {
    int ends[2] = {-1, -1};
    if (::pipe2(ends, O_CLOEXEC) != 0) return;
    output = Descriptor(ends[0]);
    input = Descriptor(ends[1]);
  }
};

/// A word that no other process has in its environment.
std::string new_mark() {
  static std::atomic<unsigned> count = 0;  // Two threads may start a child at the same moment.
  return fmt::format("{}-{}-{}", ::getpid(), ++count,
                     std::chrono::steady_clock::now().time_since_epoch().count());
}

/// The environment of this process, with the child's variables replacing equal names.
std::vector<std::string> environment_of(const ChildSetup& setup, const std::string& mark) {
  auto added = setup.environment;
  const char* marks = std::getenv(kFamilyVariable);
  added.emplace_back(kFamilyVariable, marks != nullptr ? marks + (" " + mark) : mark);
  std::vector<std::string> all;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text(*entry);
    bool replaced = false;
    for (const auto& [name, value] : added) replaced = replaced || text.starts_with(name + "=");
    if (!replaced) all.emplace_back(text);
  }
  for (const auto& [name, value] : added) all.push_back(name + "=" + value);
  return all;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// Data of the child between fork and exec, where it may not allocate memory.
struct Prepared {
  std::string program, folder, oom_score;
  std::vector<std::string> arguments, environment;
  std::vector<char*> argument_pointers, environment_pointers;
  std::vector<std::pair<int, int>> descriptors;
  std::vector<int> spare;

  Prepared(const ChildSetup& setup, const std::string& mark, int oom_score_adj)
      : program(setup.program),
        folder(setup.folder.string()),
        oom_score(std::to_string(oom_score_adj)),
        arguments(setup.arguments),
        environment(environment_of(setup, mark)),
        argument_pointers(pointers_to(arguments)),
        environment_pointers(pointers_to(environment)),
        descriptors(setup.descriptors),
        spare(descriptors.size(), -1) {}
};

/// Resets signals that this process blocks or ignores.
void reset_signals() {
  for (int signal = 1; signal < NSIG; ++signal) std::signal(signal, SIG_DFL);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
}

/// A copy of a descriptor above the child's descriptors. @return -1 if there are too many
int spare_copy(int descriptor) {
  const int copy = ::fcntl(descriptor, F_DUPFD_CLOEXEC, kFirstSpare);
  if (copy < 0 && errno == EINVAL) errno = EMFILE;  // The limit is below the first of them.
  return copy;
}

/// Sets the child's descriptors and closes all others. @return false, with the reason in errno, if
/// that is not possible
bool place_descriptors(Prepared& prepared, int output) {
  // First out of the way, then into place: a source may have the number of another's place.
  for (std::size_t i = 0; i < prepared.spare.size(); ++i) {
    prepared.spare[i] = spare_copy(prepared.descriptors[i].first);
    if (prepared.spare[i] < 0) return false;
  }
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  ::close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);
  for (std::size_t i = 0; i < prepared.spare.size(); ++i) {
    ::dup2(prepared.spare[i], prepared.descriptors[i].second);
  }
  return true;
}

/// Reports to the parent why the child cannot start, and exits.
[[noreturn]] void give_up(int report) {
  const int reason = errno;
  (void)!::write(report, &reason, sizeof reason);
  ::_exit(127);
}

/// Sets the score of the child; all its descendants inherit it.
void set_oom_score(const std::string& score) {
  const int file = ::open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  (void)!::write(file, score.data(), score.size());
  ::close(file);
}

/// Only calls that are safe between fork and exec. Writes the reason to `report` if exec fails.
[[noreturn]] void become_child(Prepared& prepared, int output, int report, pid_t parent) {
  ::setsid();
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  set_oom_score(prepared.oom_score);
  reset_signals();
  const int kept_report = spare_copy(report);
  if (kept_report < 0) give_up(report);
  if (!place_descriptors(prepared, output)) give_up(kept_report);
  if (prepared.folder.empty() || ::chdir(prepared.folder.c_str()) == 0) {
    ::execve(prepared.program.c_str(), prepared.argument_pointers.data(),
             prepared.environment_pointers.data());
  }
  give_up(kept_report);
}

/// Waits until exec has worked. @return 0, or the system's error number
int reason_of_failure(int report) {
  int reason = 0;
  ssize_t got = 0;
  while ((got = ::read(report, &reason, sizeof reason)) < 0 && errno == EINTR) continue;
  return got == sizeof reason ? reason : 0;
}

}  // namespace

StartedChild start_child(const ChildSetup& setup, int oom_score_adj) {
  StartedChild child;
  child.mark = new_mark();
  Prepared prepared(setup, child.mark, oom_score_adj);
  Pipe output, report;
  const pid_t parent = ::getpid();
  const bool ready = output.input.valid() && report.input.valid();
  child.process = ready ? ::fork() : -1;
  if (child.process < 0) {
    child.reason = errno;
    return child;
  }
  if (child.process == 0) {
    become_child(prepared, output.input.get(), report.input.get(), parent);
  }
  report.input.close();
  child.output = std::move(output.output);
  child.reason = reason_of_failure(report.output.get());
  if (child.reason == 0) return child;
  while (::waitpid(child.process, nullptr, 0) < 0 && errno == EINTR) continue;
  child.process = -1;
  return child;
}

}  // namespace raymoval
