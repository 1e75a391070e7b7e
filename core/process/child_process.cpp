// SPDX-License-Identifier: MIT
#include "core/process/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <system_error>

#include "core/files/descriptor.h"
#include "core/process/family_memory.h"
#include "core/process/proc_files.h"
#include "core/process/process_family.h"
#include "core/process/start_child.h"
#include "core/process/subreaper_scope.h"

namespace raymoval {
namespace {

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
