// SPDX-License-Identifier: MIT
#include "benchmark/harness.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

#include "benchmark/cli/command.h"
#include "core/terminal_colour.h"

namespace raymoval {
namespace {

const MethodRegistry* known_methods = nullptr;
std::vector<std::string> given_arguments;
std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler sets it");

void on_interrupt(int) {
  interrupted.store(true);
  std::signal(SIGINT, SIG_DFL);
}

ExitCode run_program(int argc, const char* const* argv) {
  CommandParser program("raymoval: evaluates the removal of moving objects from LiDAR maps.",
                        "raymoval");
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
      "`raymoval help COMMAND` says more. Exit codes: 0 done, 1 a cell or a check failed or got "
      "worse,\n"
      "2 cannot be done as asked, 3 internal error.");
  std::vector<Command> commands;
  for (const auto add :
       {add_run_command, add_plan_command, add_run_method_command, add_table_command,
        add_compare_command, add_list_command, add_describe_command, add_score_command,
        add_clean_command, add_simulate_command, add_inspect_command, add_picture_command,
        add_report_command, add_help_command, add_completion_command}) {
    commands.push_back(add(program));
  }
  const std::string chosen = program.parse(argc, argv);
  for (const Command& command : commands) {
    if (command.name == chosen) return command.run();
  }
  return ExitCode::kDone;
}

ExitCode show_error(const std::string& message, ExitCode code) {
  print_error(coloured("raymoval:", TerminalColour::kBad, stderr) + " " + message);
  return code;
}

}  // namespace

const std::vector<std::string>& program_arguments() {
  return given_arguments;
}

const MethodRegistry& program_methods() {
  return *known_methods;
}

const std::atomic<bool>& interrupt_flag() {
  std::signal(SIGINT, on_interrupt);
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
  known_methods = &methods;
  given_arguments.assign(argv + std::min(argc, 1), argv + argc);
  // A file that outgrows its limit is then an error of writing, like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  ExitCode code = ExitCode::kInternal;
  try {
    code = run_program(argc, argv);
  } catch (const std::bad_alloc&) {
    code = show_error("there was not enough memory. Choose fewer --frames.", ExitCode::kCannotDo);
  } catch (const std::exception& error) {
    const auto* known = dynamic_cast<const Error*>(&error);
    code = known == nullptr ? ExitCode::kInternal : known->exit_code();
    const bool internal = code == ExitCode::kInternal;
    show_error((internal ? "internal error, please report it: " : "") + std::string(error.what()),
               code);
  }
  return static_cast<int>(code);
}

}  // namespace raymoval
