// SPDX-License-Identifier: MIT
#include "core/process/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

#include "core/files/descriptor.h"
#include "core/process/proc_files.h"
#include "core/process/process_family.h"
#include "core/process/subreaper_scope.h"

namespace raymoval {
namespace {

/// A child process that was started, or the reason why it was not.
struct StartedChild {
  pid_t process = -1;  ///< -1 if it could not be started.
  int reason = 0;      ///< The system's error number if it could not be started.
  Descriptor output;   ///< Its standard output and error.
  std::string mark;    ///< Of its family, see `ProcessFamily`.
};

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

/// Starts a child process, see `run_child`.
/// @param oom_score_adj of the child and, since it is inherited, of all processes that it starts
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

using Clock = std::chrono::steady_clock;

constexpr int kTickMs = 20;

constexpr std::size_t kTailBytes = 4096;

/// Reads a pipe and keeps the last 4 KiB.
class OutputTail {
 public:
  explicit OutputTail(Descriptor pipe);

  /// The pipe to wait for; -1 when all writers have closed it.
  [[nodiscard]] int pipe() const { return pipe_.get(); }
  /// Reads the available bytes without waiting, but at most 4 MiB, so that a program that never
  /// stops printing does not delay the time limit.
  void drain();
  /// The last 4 KiB. If there was more, the text starts with a whole line where that is possible.
  [[nodiscard]] std::string text() const;

 private:
  Descriptor pipe_;
  std::string text_;
};

OutputTail::OutputTail(Descriptor pipe) : pipe_(std::move(pipe)) {
  ::fcntl(pipe_.get(), F_SETFL, O_NONBLOCK);
}

void OutputTail::drain() {
  char buffer[65536];
  for (int reads = 0; pipe_.valid() && reads < 64; ++reads) {
    const ssize_t got = ::read(pipe_.get(), buffer, sizeof buffer);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return;
    if (got == 0) pipe_.close();
    text_.append(buffer, static_cast<std::size_t>(got));
    if (text_.size() > 16 * kTailBytes) text_.erase(0, text_.size() - kTailBytes - 1);
  }
}

std::string OutputTail::text() const {
  if (text_.size() <= kTailBytes) return text_;
  // The byte before the tail shows whether the tail starts a line.
  const std::string tail = text_.substr(text_.size() - kTailBytes - 1);
  const std::size_t line = tail.find('\n');
  return tail.substr(line == std::string::npos || line + 1 == tail.size() ? 1 : line + 1);
}

/// Size on the disk of the files below a folder. Files may disappear meanwhile: a file that cannot
/// be read does not count.
double folder_size_mib(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  constexpr auto kSkip = fs::directory_options::skip_permission_denied;
  double mib = 0.0;
  // The forms that take an error_code end the program if they have no memory.
  try {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder, kSkip)) {
      struct stat status {};
      if (::lstat(entry.path().c_str(), &status) != 0) continue;
      mib += static_cast<double>(status.st_blocks) / 2048.0;
    }
  } catch (const fs::filesystem_error&) {
    // A folder disappeared; the next measurement has the rest.
  }
  return mib;
}

/// Watches a running child until it ends or must be ended.
class ChildWatch {
 public:
  ChildWatch(const ChildSetup& setup, StartedChild child, const SubreaperScope& foster)
      : setup_(setup),
        child_(child.process),
        family_(child.process, child.mark, &foster),
        memory_(setup.limits.memory_mib),
        tail_(std::move(child.output)),
        handle_(static_cast<int>(::syscall(SYS_pidfd_open, child.process, 0))) {}

  ChildEnd wait() {
    while (!has_ended()) {
      check_limits();
      pollfd waited[2] = {{handle_.get(), POLLIN, 0}, {tail_.pipe(), POLLIN, 0}};
      ::poll(waited, 2, kTickMs);
      tail_.drain();
    }
    family_.end();
    int status = 0;
    while (::waitpid(child_, &status, 0) < 0 && errno == EINTR) continue;
    if (!stopped_) note_output();
    if (memory_.counts_shares_in_full()) {
      end_.memory_note =
          " Memory that its processes share was counted for each of them, because "
          "/proc/PID/smaps_rollup could not be read.";
    }
    if (stopped_) return end_;
    end_.kind = WIFSIGNALED(status) ? ChildEnd::Kind::kSignalled : ChildEnd::Kind::kExited;
    end_.code = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status);
    if (was_ended_from_outside() && is_cancelled_soon()) end_.kind = ChildEnd::Kind::kCancelled;
    return end_;
  }

 private:
  /// Whether the child has ended. It stays a zombie, so that its number is not used again.
  [[nodiscard]] bool has_ended() const {
    siginfo_t info{};
    const int got = ::waitid(P_PID, static_cast<id_t>(child_), &info, WEXITED | WNOHANG | WNOWAIT);
    return (got == 0 && info.si_pid == child_) || (got < 0 && errno == ECHILD);
  }

  [[nodiscard]] bool is_cancelled() const {
    return setup_.cancel != nullptr && setup_.cancel->load();
  }

  [[nodiscard]] bool was_ended_from_outside() const {
    const bool killed = end_.kind == ChildEnd::Kind::kSignalled && end_.code == SIGKILL;
    return killed || asking_signal(end_) != 0;
  }

  /// A system that shuts down signals all processes, and perhaps the child first.
  [[nodiscard]] bool is_cancelled_soon() const {
    constexpr int kTicks = 10;
    for (int i = 0; setup_.cancel != nullptr && i < kTicks && !is_cancelled(); ++i) {
      ::poll(nullptr, 0, kTickMs);
    }
    return is_cancelled();
  }

  void note_output() {
    tail_.drain();
    end_.output_tail = tail_.text();
  }

  void stop(ChildEnd::Kind kind) {
    stopped_ = true;
    end_.kind = kind;
    note_output();  // Without output while its descendants are ended.
    family_.end();
  }

  void check_limits() {
    const Clock::time_point now = Clock::now();
    if (stopped_ || now < next_look_) return;
    next_look_ = now + std::chrono::milliseconds(kTickMs);
    const std::chrono::duration<double> elapsed = now - started_;
    const double memory = memory_.measure(family_.members());
    end_.largest_mib = std::max(end_.largest_mib, memory);
    const ChildLimits& limits = setup_.limits;
    if (is_cancelled()) {
      stop(ChildEnd::Kind::kCancelled);
    } else if (limits.seconds > 0.0 && elapsed.count() > limits.seconds) {
      stop(ChildEnd::Kind::kTimeout);
    } else if (limits.memory_mib > 0.0 && memory > limits.memory_mib) {
      stop(ChildEnd::Kind::kOutOfMemory);
    } else if (exceeds_folder()) {
      stop(ChildEnd::Kind::kOutOfDisk);
    }
  }

  [[nodiscard]] bool exceeds_folder() {
    if (setup_.limits.folder_mib <= 0.0 || !folder_pace_.is_due()) return false;
    folder_pace_.begin();
    const double size = folder_size_mib(setup_.folder);
    folder_pace_.end();
    return size > setup_.limits.folder_mib;
  }

  const ChildSetup& setup_;
  pid_t child_;
  ProcessFamily family_;
  FamilyMemory memory_;
  Pace folder_pace_{std::chrono::milliseconds(1000)};
  OutputTail tail_;
  Descriptor handle_;
  Clock::time_point started_ = Clock::now();
  Clock::time_point next_look_ = started_;
  bool stopped_ = false;
  ChildEnd end_;
};

}  // namespace

ChildEnd run_child(const ChildSetup& setup) {
  SubreaperScope foster;
  StartedChild child = start_child(setup, foster.score());
  if (child.process >= 0) {
    foster.set_head(child.process);
    return ChildWatch(setup, std::move(child), foster).wait();
  }
  ChildEnd end;
  end.kind = ChildEnd::Kind::kNotStarted;
  end.code = child.reason;
  return end;
}

std::string not_started_text(int reason) {
  if (reason == EMFILE || reason == ENFILE) {
    return fmt::format("no process can be started ({}). Raise the limit of open files (ulimit -n).",
                       std::generic_category().message(reason));
  }
  return fmt::format(
      "no process can be started ({}). End other programs, or raise the limit of "
      "processes (ulimit -u).",
      std::generic_category().message(reason));
}

int asking_signal(const ChildEnd& end) {
  if (end.kind != ChildEnd::Kind::kSignalled && end.kind != ChildEnd::Kind::kExited) return 0;
  const int signal = end.kind == ChildEnd::Kind::kSignalled ? end.code : end.code - 128;
  return signal == SIGINT || signal == SIGTERM || signal == SIGHUP ? signal : 0;
}

std::string signal_text(int signal) {
  const char* description = ::sigdescr_np(signal);
  return fmt::format("signal {} ({})", signal, description != nullptr ? description : "unknown");
}

}  // namespace raymoval
