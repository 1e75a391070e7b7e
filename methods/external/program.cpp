// SPDX-License-Identifier: MIT
#include "methods/external/program.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <system_error>

#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kTailBytes = 4096;
constexpr int kTickMs = 20;

std::string reason_text(int error) {
  return std::generic_category().message(error);
}

/// Both ends of a pipe; neither outlives an exec.
struct Pipe {
  int ends[2] = {-1, -1};

  Pipe() {
    if (::pipe2(ends, O_CLOEXEC) != 0) {
      throw MethodError("no program can be started (" + reason_text(errno) + ")");
    }
  }
  ~Pipe() {
    close(0);
    close(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void close(int end) {
    if (ends[end] >= 0) ::close(ends[end]);
    ends[end] = -1;
  }
};

/// The file that `name` starts, as a shell would find it.
std::string found_program(const std::string& name) {
  if (name.find('/') != std::string::npos) return name;
  const char* path = std::getenv("PATH");
  for (const std::string_view folder : split(path != nullptr ? path : "/usr/bin:/bin", ':')) {
    const std::filesystem::path file = std::filesystem::path(folder.empty() ? "." : folder) / name;
    std::error_code ignored;
    if (::access(file.c_str(), X_OK) == 0 && std::filesystem::is_regular_file(file, ignored)) {
      return std::filesystem::absolute(file, ignored).string();
    }
  }
  throw MethodError("the program '" + name +
                    "' is not on PATH; install it, or name it by its path in the manifest");
}

/// This process's environment with the call's on top.
std::vector<std::string> environment_of(const ProgramCall& call) {
  std::vector<std::string> all;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text(*entry);
    bool replaced = false;
    for (const auto& [name, value] : call.environment) {
      replaced = replaced || text.starts_with(name + "=");
    }
    if (!replaced) all.emplace_back(text);
  }
  for (const auto& [name, value] : call.environment) all.push_back(name + "=" + value);
  return all;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// What the child needs between fork and exec, made before.
struct Prepared {
  std::string program, folder;
  std::vector<std::string> arguments, environment;
  std::vector<char*> argument_pointers, environment_pointers;

  explicit Prepared(const ProgramCall& call)
      : program(found_program(call.command.front())),
        folder(call.folder.string()),
        arguments(call.command),
        environment(environment_of(call)),
        argument_pointers(pointers_to(arguments)),
        environment_pointers(pointers_to(environment)) {}
};

/// Only calls that are safe between fork and exec. Tells `report` why if it does not work out.
[[noreturn]] void become_program(const Prepared& prepared, int output, int report, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  // Whatever else this process has open is not the program's.
  ::close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);
  if (::chdir(prepared.folder.c_str()) == 0) {
    ::execve(prepared.program.c_str(), prepared.argument_pointers.data(),
             prepared.environment_pointers.data());
  }
  const int reason = errno;
  (void)!::write(report, &reason, sizeof reason);
  ::_exit(127);
}

/// The processes that `process` started. It is stopped first, so that it starts no more.
void collect_family(pid_t process, std::vector<pid_t>& family) {
  family.push_back(process);
  ::kill(process, SIGSTOP);
  std::error_code error;
  const std::string tasks = "/proc/" + std::to_string(process) + "/task";
  for (auto thread = std::filesystem::directory_iterator(tasks, error);
       !error && thread != std::filesystem::directory_iterator(); thread.increment(error)) {
    std::ifstream children(thread->path() / "children");
    for (pid_t child = 0; children >> child;) collect_family(child, family);
  }
}

/// A program that was started; ended with all that it started unless it ended by itself.
class Running {
 public:
  explicit Running(pid_t process) : process_(process) {}
  ~Running() {
    if (process_ < 0) return;
    std::vector<pid_t> family;
    collect_family(process_, family);
    for (const pid_t member : family) ::kill(member, SIGKILL);
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  /// Whether it has ended; then `status` is as of waitpid.
  bool ended(int& status) {
    if (::waitpid(process_, &status, WNOHANG) != process_) return false;
    process_ = -1;
    return true;
  }

 private:
  pid_t process_;
};

/// Keeps the end of what comes out of a pipe.
class Tail {
 public:
  explicit Tail(int pipe) : pipe_(pipe) { ::fcntl(pipe, F_SETFL, O_NONBLOCK); }
  /// Waits up to `milliseconds` for output and takes what is there.
  void wait(int milliseconds) {
    pollfd readable{open_ ? pipe_ : -1, POLLIN, 0};
    ::poll(&readable, 1, milliseconds);
    drain();
  }
  void drain() {
    char buffer[4096];
    // At most so much at once: a program that never stops printing must not hold up the clock.
    for (int round = 0; open_ && round < 64; ++round) {
      const ssize_t got = ::read(pipe_, buffer, sizeof buffer);
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) return;
      if (got == 0) open_ = false;
      text_.append(buffer, static_cast<std::size_t>(got));
      if (text_.size() > kTailBytes) text_.erase(0, text_.size() - kTailBytes);
    }
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  int pipe_;
  bool open_ = true;
  std::string text_;
};

/// `message`, and what the program printed last.
std::string with_output(const std::string& message, const std::string& output) {
  const std::size_t end = output.find_last_not_of(" \n\r\t");
  if (end == std::string::npos) return message + " and printed nothing";
  return message + ". It printed last:\n" + output.substr(0, end + 1);
}

void check_end(int status, const std::string& program, const std::string& output) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  const std::string how = WIFEXITED(status)
                              ? "ended with exit code " + std::to_string(WEXITSTATUS(status))
                              : "was ended by signal " + std::to_string(WTERMSIG(status)) + " (" +
                                    ::strsignal(WTERMSIG(status)) + ")";
  throw MethodError(with_output("'" + program + "' " + how, output));
}

pid_t start(const Prepared& prepared, Pipe& output, Pipe& report) {
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) throw MethodError("no program can be started (" + reason_text(errno) + ")");
  if (child == 0) become_program(prepared, output.ends[1], report.ends[1], parent);
  output.close(1);
  report.close(1);
  return child;
}

/// Waits until exec worked. @throws MethodError why it did not
void check_started(const Prepared& prepared, const Pipe& report) {
  int reason = 0;
  ssize_t got = 0;
  while ((got = ::read(report.ends[0], &reason, sizeof reason)) < 0 && errno == EINTR) {
  }
  if (got != sizeof reason) return;
  throw MethodError("'" + prepared.program + "' cannot be started (" + reason_text(reason) + ")");
}

}  // namespace

std::string run_program(const ProgramCall& call) {
  const Prepared prepared(call);
  Pipe output, report;
  const auto started = Clock::now();
  Running running(start(prepared, output, report));
  check_started(prepared, report);
  Tail tail(output.ends[0]);
  int status = 0;
  while (!running.ended(status)) {
    if (call.cancel != nullptr && call.cancel->load()) throw Cancelled();
    const std::chrono::duration<double> elapsed = Clock::now() - started;
    if (call.time_limit_s > 0.0 && elapsed.count() > call.time_limit_s) {
      throw MethodError(with_output("'" + prepared.program + "' did not end within " +
                                        number_text(call.time_limit_s) + " s and was ended",
                                    tail.text()));
    }
    tail.wait(kTickMs);
  }
  tail.drain();
  if (call.cancel != nullptr && call.cancel->load()) throw Cancelled();
  check_end(status, prepared.program, tail.text());
  return tail.text();
}

}  // namespace raymoval
