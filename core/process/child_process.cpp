// SPDX-License-Identifier: MIT
#include "core/process/child_process.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <system_error>

#include "core/process/output_tail.h"
#include "core/process/process_family.h"
#include "core/process/start_child.h"

namespace raymoval {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kTickMs = 20;

/// Watches a running child until it ends or has to be ended.
class ChildWatch {
 public:
  ChildWatch(const ChildSetup& setup, StartedChild child)
      : setup_(setup),
        child_(child.process),
        family_(child.process, child.mark),
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
    tail_.drain();
    end_.output_tail = tail_.text();
    if (stopped_) return end_;
    end_.kind = WIFSIGNALED(status) ? ChildEnd::Kind::kSignalled : ChildEnd::Kind::kExited;
    end_.code = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status);
    return end_;
  }

 private:
  /// Whether it has ended. It stays a zombie, so that its number is not used again.
  [[nodiscard]] bool has_ended() const {
    siginfo_t info{};
    const int got = ::waitid(P_PID, static_cast<id_t>(child_), &info, WEXITED | WNOHANG | WNOWAIT);
    return (got == 0 && info.si_pid == child_) || (got < 0 && errno == ECHILD);
  }

  void stop(ChildEnd::Kind kind) {
    stopped_ = true;
    end_.kind = kind;
    family_.end();
  }

  void check_limits() {
    const Clock::time_point now = Clock::now();
    if (stopped_ || now < next_look_) return;
    next_look_ = now + std::chrono::milliseconds(kTickMs);
    const std::chrono::duration<double> elapsed = now - started_;
    const double memory = family_.memory_mib();
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
  ProcessFamily family_;
  OutputTail tail_;
  Descriptor handle_;
  Clock::time_point started_ = Clock::now();
  Clock::time_point next_look_ = started_;
  bool stopped_ = false;
  ChildEnd end_;
};

}  // namespace

ChildEnd run_child(const ChildSetup& setup) {
  StartedChild child = start_child(setup);
  if (child.process >= 0) return ChildWatch(setup, std::move(child)).wait();
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

std::string signal_text(int signal) {
  const char* description = ::sigdescr_np(signal);
  return fmt::format("signal {} ({})", signal, description != nullptr ? description : "unknown");
}

}  // namespace raymoval
