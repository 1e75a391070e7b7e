// SPDX-License-Identifier: MIT
#include <memory>

#include "benchmark/cli/commands.h"
#include "benchmark/cli/shell/completion.h"
#include "benchmark/cli/shell/manual_page.h"
#include "core/text.h"

namespace raymoval {
namespace {

struct HelpFlags {
  std::string command;
  bool man = false;
};

ExitCode help(const CommandParser& program, const HelpFlags& flags) {
  if (flags.man && !flags.command.empty()) {
    throw UsageError("--man is one page of all commands; leave '" + flags.command + "' out.");
  }
  print(flags.man ? manual_page(command_tree(program, program_methods()))
                  : program.help_page(flags.command));
  return ExitCode::kDone;
}

}  // namespace

Command add_help_command(CommandParser& program) {
  auto flags = std::make_shared<HelpFlags>();
  CommandOptions options =
      program.add_command("help", "Tells what a command does, as its --help does");
  options.add("command", "COMMAND", flags->command, "Command to tell of; all if empty");
  options.add_flag("--man", flags->man, "The manual page raymoval(1), as text for man -l");
  options.set_footer(
      "Examples:\n"
      "  raymoval help\n"
      "  raymoval help run\n"
      "  raymoval help --man | man -l -");
  return {options.name(), [&program, flags] { return help(program, *flags); }};
}

Command add_completion_command(CommandParser& program) {
  auto shell = std::make_shared<std::string>();
  CommandOptions options =
      program.add_command("completion", "Prints a script with which a shell completes raymoval");
  options.add("shell", "SHELL", *shell, "bash, zsh or fish");
  options.set_footer(
      "If raymoval is installed, the scripts are already where the shells look for them. If it is "
      "not, load them:\n"
      "  source <(raymoval completion bash)\n"
      "  source <(raymoval completion zsh)\n"
      "  raymoval completion fish | source");
  return {options.name(), [&program, shell] {
            if (shell->empty()) throw UsageError("for which shell? Name bash, zsh or fish.");
            print(completion_script(command_tree(program, program_methods()), *shell));
            return ExitCode::kDone;
          }};
}

}  // namespace raymoval
