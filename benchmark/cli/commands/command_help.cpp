// SPDX-License-Identifier: MIT
#include <memory>

#include "benchmark/cli/command.h"

namespace raymoval {

Command add_help_command(CommandParser& program) {
  auto command = std::make_shared<std::string>();
  CommandOptions options =
      program.add_command("help", "Prints the help of a command, as its --help does");
  options.add("command", "COMMAND", *command, "A command; all of them if empty");
  options.set_footer("Examples:\n  raymoval help\n  raymoval help run");
  return {options.name(), [&program, command] {
            print(program.help_page(*command));
            return ExitCode::kDone;
          }};
}

}  // namespace raymoval
