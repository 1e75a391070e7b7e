// SPDX-License-Identifier: MIT
#include "core/process/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "core/error.h"
#include "core/files/descriptor.h"
#include "core/text.h"

namespace raymoval {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kTailBytes = 4096;
constexpr int kTickMs = 20;
constexpr int kFirstSpare = 64;  ///< Above all descriptors that a child is given.

/// Only calls that are safe between fork and exec; `arguments` was made before.
[[noreturn]] void become_child(const ChildSetup& setup, char* const* arguments, int output,
                               pid_t parent) {
  ::setsid();
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  // First out of the way, then into place: a source may have the number of another's place.
  int spare[8];
  const std::size_t count = std::min<std::size_t>(setup.descriptors.size(), std::size(spare));
  for (std::size_t i = 0; i < count; ++i) {
    spare[i] = ::fcntl(setup.descriptors[i].first, F_DUPFD_CLOEXEC, kFirstSpare);
  }
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  for (std::size_t i = 0; i < count; ++i) ::dup2(spare[i], setup.descriptors[i].second);
  ::execv("/proc/self/exe", arguments);
  ::_exit(127);
}

/// Lets the system end the child and not this process when memory runs out.
void offer_to_oom_killer(pid_t child) {
  std::ofstream("/proc/" + std::to_string(child) + "/oom_score_adj") << "800";
}

/// Resident memory of one process that is no file's, in MiB.
double memory_of(const std::string& process) {
  std::ifstream status(process + "/status");
  double kibibytes = 0.0;
  for (std::string line; std::getline(status, line);) {
    if (!line.starts_with("RssAnon:") && !line.starts_with("RssShmem:")) continue;
    const auto pieces = split_blanks(line);
    if (pieces.size() > 1) kibibytes += parse_number<double>(pieces[1]).value_or(0.0);
  }
  return kibibytes / 1024.0;
}

/// Processes that `process` started and those that they started.
void add_descendants(const std::string& process, std::vector<std::string>& found) {
  std::error_code error;
  for (const auto& thread : std::filesystem::directory_iterator(process + "/task", error)) {
    std::ifstream children(thread.path() / "children");
    for (std::string pid; children >> pid;) {
      found.push_back("/proc/" + pid);
      add_descendants(found.back(), found);
    }
  }
}

std::vector<std::string> family_of(pid_t child) {
  std::vector<std::string> family = {"/proc/" + std::to_string(child)};
  try {
    add_descendants(family.front(), family);
  } catch (const std::filesystem::filesystem_error&) {
    // A process that ends while it is looked at.
  }
  return family;
}

/// Ends the child with all that it started, also what left its session.
void end_family(pid_t child) {
  for (const std::string& process : family_of(child)) {
    const auto pid = parse_number<int>(std::string_view(process).substr(std::strlen("/proc/")));
    if (pid) ::kill(*pid, SIGKILL);
  }
  ::kill(-child, SIGKILL);
}

/// Keeps the end of what comes out of a pipe.
class Tail {
 public:
  explicit Tail(int pipe) : pipe_(pipe) { ::fcntl(pipe, F_SETFL, O_NONBLOCK); }
  [[nodiscard]] bool open() const { return open_; }
  void drain() {
    char buffer[65536];
    for (int reads = 0; open_ && reads < 64; ++reads) {
      const ssize_t got = ::read(pipe_, buffer, sizeof buffer);
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) return;
      if (got == 0) open_ = false;
      text_.append(buffer, static_cast<std::size_t>(got));
      if (text_.size() > 16 * kTailBytes) text_.erase(0, text_.size() - kTailBytes - 1);
    }
  }
  /// Whole lines where possible.
  [[nodiscard]] std::string text() const {
    if (text_.size() <= kTailBytes) return text_;
    const std::string tail = text_.substr(text_.size() - kTailBytes);
    const std::size_t line = tail.find('\n');
    return line == std::string::npos || line + 1 == tail.size() ? tail : tail.substr(line + 1);
  }

 private:
  int pipe_;
  bool open_ = true;
  std::string text_;
};

/// Watches a running child until it ends or has to be ended.
class Watch {
 public:
  Watch(const ChildSetup& setup, pid_t child, int output)
      : setup_(setup),
        child_(child),
        output_(output),
        tail_(output),
        handle_(static_cast<int>(::syscall(SYS_pidfd_open, child, 0))) {}

  ChildEnd wait() {
    while (!ended()) {
      look();
      pollfd waited[2] = {{handle_.get(), POLLIN, 0}, {tail_.open() ? output_ : -1, POLLIN, 0}};
      ::poll(waited, 2, kTickMs);
      tail_.drain();
    }
    end_family(child_);
    int status = 0;
    while (::waitpid(child_, &status, 0) < 0 && errno == EINTR) continue;
    tail_.drain();
    end_.output_tail = tail_.text();
    if (stopped_) return end_;
    end_.kind = WIFSIGNALED(status) ? ChildEnd::Kind::kSignalled : ChildEnd::Kind::kExited;
    end_.code = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status);
    return end_;
  }

 private:
  /// Whether it has ended; it stays a zombie, so that its number is not used again.
  [[nodiscard]] bool ended() const {
    siginfo_t info{};
    const int got = ::waitid(P_PID, static_cast<id_t>(child_), &info, WEXITED | WNOHANG | WNOWAIT);
    return (got == 0 && info.si_pid == child_) || (got < 0 && errno == ECHILD);
  }

  void stop(ChildEnd::Kind kind) {
    stopped_ = true;
    end_.kind = kind;
    end_family(child_);
  }

  void look() {
    const Clock::time_point now = Clock::now();
    if (stopped_ || now < next_look_) return;
    next_look_ = now + std::chrono::milliseconds(kTickMs);
    const std::chrono::duration<double> elapsed = now - started_;
    double memory = 0.0;
    for (const std::string& process : family_of(child_)) memory += memory_of(process);
    end_.largest_mib = std::max(end_.largest_mib, memory);
    const ChildLimits& limits = setup_.limits;
    if (setup_.cancel != nullptr && setup_.cancel->load()) {
      stop(ChildEnd::Kind::kCancelled);
    } else if (limits.seconds > 0.0 && elapsed.count() > limits.seconds) {
      stop(ChildEnd::Kind::kTimeout);
    } else if (limits.memory_mib > 0.0 && memory > limits.memory_mib) {
      stop(ChildEnd::Kind::kOutOfMemory);
    }
  }

  const ChildSetup& setup_;
  pid_t child_;
  int output_;
  Tail tail_;
  Descriptor handle_;
  Clock::time_point started_ = Clock::now();
  Clock::time_point next_look_ = started_;
  bool stopped_ = false;
  ChildEnd end_;
};

}  // namespace

ChildEnd run_child(const ChildSetup& setup) {
  std::vector<std::string> words = {"raymoval"};
  words.insert(words.end(), setup.arguments.begin(), setup.arguments.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  int ends[2] = {-1, -1};
  if (::pipe2(ends, O_CLOEXEC) != 0) {
    throw DataError("no pipe can be made (" + std::generic_category().message(errno) + ").");
  }
  const Descriptor output(ends[0]);
  Descriptor input(ends[1]);
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) {
    throw DataError("no process can be started (" + std::generic_category().message(errno) +
                    "). End other programs, or raise the limit of processes (ulimit -u).");
  }
  if (child == 0) become_child(setup, arguments.data(), input.get(), parent);
  input.close();
  offer_to_oom_killer(child);
  return Watch(setup, child, output.get()).wait();
}

double machine_memory_mib() {
  double mib = 0.0;
  std::ifstream memory("/proc/meminfo");
  for (std::string line; std::getline(memory, line);) {
    const auto pieces = split_blanks(line);
    if (!line.starts_with("MemTotal:") || pieces.size() < 2) continue;
    mib = parse_number<double>(pieces[1]).value_or(0.0) / 1024.0;
  }
  for (const char* path :
       {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
    std::ifstream file(path);
    std::string text;
    if (!(file >> text)) continue;
    const auto bytes = parse_number<double>(text);  // "max" is no number
    if (bytes && *bytes / 1048576.0 < mib) mib = *bytes / 1048576.0;
  }
  return mib;
}

double usual_memory_limit_mib() {
  return 0.9 * machine_memory_mib();
}

std::string signal_text(int signal) {
  const char* description = ::sigdescr_np(signal);
  return "signal " + std::to_string(signal) + " (" +
         (description != nullptr ? description : "unknown") + ")";
}

}  // namespace raymoval
