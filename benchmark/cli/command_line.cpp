// SPDX-License-Identifier: MIT
#include "benchmark/harness.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <optional>
#include <string_view>
#include <system_error>

#include "benchmark/cli/command.h"
#include "core/terminal_colour.h"

namespace raymoval {
namespace {

const MethodRegistry* known_methods = nullptr;
std::vector<std::string> given_arguments;
std::atomic<bool> interrupted = false;
std::atomic<int> interrupting_signal = 0;
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free,
              "a signal handler sets them");

/// The exit code that a shell reports for a process that was ended by a signal.
constexpr int exit_code_of_signal(int signal) {
  return 128 + signal;
}

void on_interrupt(int signal) {
  // Not by the signal's default, which the first process of a container does not have.
  if (interrupted.exchange(true)) ::_exit(exit_code_of_signal(signal));
  interrupting_signal.store(signal);
}

/// @param unless_ignored leaves a signal ignored if the parent process ignores it (nohup)
void listen_to(int signal, bool unless_ignored) {
  const auto before = std::signal(signal, on_interrupt);
  if (unless_ignored && before == SIG_IGN) std::signal(signal, SIG_IGN);
}

/// @param name of the program in help
ExitCode run_program(int argc, const char* const* argv, const std::string& name) {
  CommandParser program(
      name + ": removes moving objects from LiDAR maps, and compares methods that do so.", name);
  program.set_version("raymoval " RAYMOVAL_VERSION);
  program.set_footer(
      "Examples:\n"
      "  raymoval run quick --out out/quick\n"
      "  raymoval run simulated --out out/simulated\n"
      "  raymoval table out/quick\n"
      "  raymoval report out/quick -o quick.html\n"
      "  raymoval compare out/quick results/reference/street\n"
      "  raymoval describe raymoval\n"
      "  raymoval clean data/05 -o static.pcd\n"
      "  raymoval inspect data/05\n"
      "  raymoval simulate town -o data/town\n"
      "`raymoval help COMMAND` shows the options of a command. Exit codes: 0 success, 1 a cell or "
      "a check\n"
      "failed or got worse, 2 wrong usage or unusable input, 3 internal error, 128 + N ended by "
      "signal N.");
  std::vector<Command> commands;
  for (const auto add :
       {add_run_command, add_plan_command, add_run_method_command, add_table_command,
        add_compare_command, add_list_command, add_describe_command, add_cite_command,
        add_score_command, add_clean_command, add_simulate_command, add_inspect_command,
        add_picture_command, add_report_command, add_help_command}) {
    commands.push_back(add(program));
  }
  const std::string chosen = program.parse(argc, argv);
  if (chosen.empty()) print(program.answer());
  for (const Command& command : commands) {
    if (command.name == chosen) return command.run();
  }
  return ExitCode::kDone;
}

constexpr std::string_view kNoMemory =
    "raymoval: there was not enough memory. Choose fewer --frames, or end other programs.\n";

/// Writes to standard error without memory. @return the exit code for it
int write_plain(std::string_view line) {
  [[maybe_unused]] const ssize_t put = ::write(STDERR_FILENO, line.data(), line.size());
  return static_cast<int>(ExitCode::kCannotDo);
}

std::atomic<bool> memory_ran_out = false;

/// Records the lack of memory for `end_with_words`: std::terminate often has no current exception.
[[noreturn]] void on_no_memory() {
  memory_ran_out = true;
  throw std::bad_alloc();
}

int show_error(const std::string& message, ExitCode code) {
  const char* internal = code == ExitCode::kInternal ? "internal error, please report it: " : "";
  print_error(in_red("raymoval:", stderr) + " " + internal + message);
  return static_cast<int>(code);
}

/// Called for an exception in a place where none may be thrown, such as in a library that ran out
/// of memory. Destructors are not run: a half-written file has no final name.
[[noreturn]] void end_with_words() {
  try {
    if (std::current_exception()) std::rethrow_exception(std::current_exception());
    if (memory_ran_out) ::_exit(write_plain(kNoMemory));
    show_error("std::terminate was called", ExitCode::kInternal);
  } catch (const std::bad_alloc&) {
    ::_exit(write_plain(kNoMemory));
  } catch (const std::exception& error) {
    show_error(error.what(), ExitCode::kInternal);
  } catch (...) {
    show_error("an exception of an unknown type was thrown", ExitCode::kInternal);
  }
  ::_exit(static_cast<int>(ExitCode::kInternal));
}

/// A low limit of open files is often only a default, which may be raised. Child processes inherit
/// the raised limit.
void raise_limit_of_open_files() {
  constexpr rlim_t kEnough = 1024;
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= kEnough) return;
  limit.rlim_cur = std::min(limit.rlim_max, kEnough);
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

/// @param methods null for the built-in ones
int run_with_words(int argc, const char* const* argv, const MethodRegistry* methods) {
  std::set_new_handler(on_no_memory);
  std::set_terminate(end_with_words);
  // A file larger than its limit is then a write error, like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  raise_limit_of_open_files();
  try {
    std::optional<MethodRegistry> built_in;
    if (methods == nullptr) methods = &built_in.emplace(MethodRegistry::built_in());
    const std::string name =
        built_in || argc < 1 ? "raymoval" : std::filesystem::path(argv[0]).filename().string();
    known_methods = methods;
    given_arguments.assign(argv + std::min(argc, 1), argv + argc);
    return static_cast<int>(run_program(argc, argv, name));
  } catch (const std::bad_alloc&) {
    return write_plain(kNoMemory);
  } catch (const Error& error) {
    return show_error(error.what(), error.exit_code());
  } catch (const std::system_error& error) {
    return show_error(std::string("a system call failed: ") + error.what(), ExitCode::kCannotDo);
  } catch (const std::exception& error) {
    return show_error(error.what(), ExitCode::kInternal);
  } catch (...) {
    return show_error("an exception of an unknown type was thrown", ExitCode::kInternal);
  }
}

/// The exit code after a signal. A command that was complete before it could be stopped keeps its
/// code.
int with_code_of_signal(int code) {
  const int signal = interrupting_signal.load();
  const bool done = code == static_cast<int>(ExitCode::kDone);
  return signal != 0 && !done ? exit_code_of_signal(signal) : code;
}

}  // namespace

const std::vector<std::string>& program_arguments() {
  return given_arguments;
}

const MethodRegistry& program_methods() {
  return *known_methods;
}

const std::atomic<bool>& interrupt_flag() {
  static const bool listens = [] {
    listen_to(SIGINT, false);  // Shells make background jobs ignore it.
    listen_to(SIGTERM, true);
    listen_to(SIGHUP, true);
    return true;
  }();
  (void)listens;
  return interrupted;
}

void print(const std::string& whole) {
  const std::string text = terminal_text(whole, stdout);
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (!written || std::fflush(stdout) != 0) {
    throw DataError("standard output cannot be written (a full disk or a closed pipe?).");
  }
}

int run_command_line(int argc, const char* const* argv, const MethodRegistry& methods) {
  return with_code_of_signal(run_with_words(argc, argv, &methods));
}

int run_command_line(int argc, const char* const* argv) {
  return with_code_of_signal(run_with_words(argc, argv, nullptr));
}

}  // namespace raymoval
