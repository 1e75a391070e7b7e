// SPDX-License-Identifier: MIT
#include <CLI/Formatter.hpp>
#include <memory>

#include "benchmark/cli/commands.h"
#include "benchmark/cli/completion.h"
#include "benchmark/cli/manual_page.h"
#include "core/text.h"

namespace raymoval {
namespace {

struct HelpFlags {
  std::string command;
  bool man = false;
};

std::string help_page(const CLI::App& program, const std::string& command) {
  const auto& formatter = *program.get_formatter();
  if (command.empty()) return formatter.make_help(&program, "raymoval", CLI::AppFormatMode::Normal);
  std::vector<std::string> names;
  for (const CLI::App* app : program.get_subcommands(std::function<bool(const CLI::App*)>())) {
    if (app->get_group().empty()) continue;  // Not shown.
    if (app->get_name() == command) {
      return formatter.make_help(app, "raymoval " + command, CLI::AppFormatMode::Normal);
    }
    names.push_back(app->get_name());
  }
  throw UsageError("'" + command + "' is no command." + suggestion(command, names));
}

ExitCode help(const CLI::App& program, const HelpFlags& flags) {
  if (flags.man && !flags.command.empty()) {
    throw UsageError("--man is one page of all commands; leave '" + flags.command + "' out.");
  }
  print(flags.man ? manual_page(command_tree(program, program_methods()))
                  : help_page(program, flags.command));
  return ExitCode::kDone;
}

}  // namespace

Command add_help_command(CLI::App& program) {
  auto flags = std::make_shared<HelpFlags>();
  CLI::App* app = program.add_subcommand("help", "Tells what a command does, as its --help does");
  app->allow_extras();
  app->add_option("command", flags->command, "Command to tell of; all if empty")
      ->type_name("COMMAND");
  app->add_flag("--man", flags->man, "The manual page raymoval(1), as text for man -l");
  app->footer(
      "Examples:\n"
      "  raymoval help\n"
      "  raymoval help run\n"
      "  raymoval help --man | man -l -");
  return {app, [&program, flags] { return help(program, *flags); }};
}

Command add_completion_command(CLI::App& program) {
  auto shell = std::make_shared<std::string>();
  CLI::App* app =
      program.add_subcommand("completion", "Prints a script with which a shell completes raymoval");
  app->allow_extras();
  app->add_option("shell", *shell, "bash, zsh or fish")->type_name("SHELL");
  app->footer(
      "If raymoval is installed, the scripts are already where the shells look for them. If it is "
      "not, load them:\n"
      "  source <(raymoval completion bash)\n"
      "  source <(raymoval completion zsh)\n"
      "  raymoval completion fish | source");
  return {app, [&program, shell] {
            if (shell->empty()) throw UsageError("for which shell? Name bash, zsh or fish.");
            print(completion_script(command_tree(program, program_methods()), *shell));
            return ExitCode::kDone;
          }};
}

}  // namespace raymoval
