// SPDX-License-Identifier: MIT
#include "benchmark/cli/command_parser.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <functional>
#include <sstream>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/text.h"
#include "datasets/open_sequence.h"

namespace raymoval {
namespace {

CLI::App& app_of(void* command) {
  return *static_cast<CLI::App*>(command);
}

std::vector<const CLI::App*> all_commands(const CLI::App& program) {
  return program.get_subcommands(std::function<bool(const CLI::App*)>());
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

bool may_be_sequence(const std::string& path) {
  return is_scene(path) || is_folder(path.substr(0, path.rfind(':'))) || is_folder(path);
}

/// The parser keeps unknown options and words. Here they become an error that names the nearest
/// known one.
void check_nothing_left(const CLI::App& app, const std::string& help) {
  const std::vector<std::string> left = app.remaining();
  if (left.empty()) return;
  std::string unknown = left.front();
  for (const std::string& word : left) {
    if (word.starts_with("-")) {
      unknown = word;
      break;
    }
  }
  const std::string name = unknown.substr(0, unknown.find('='));
  if (!name.starts_with("-")) {
    // Every file that a command writes follows an option.
    const bool writes = app.get_option_no_throw("-o") != nullptr;
    const bool reads = !writes && app.get_option_no_throw("--sequence") != nullptr;
    throw UsageError(
        "'" + name + "' was not expected here." +
        (writes ? " To write there put -o before it." : "") +
        (reads && may_be_sequence(name) ? " Name it with --sequence " + name + "." : "") +
        " See `" + help + " --help`.");
  }
  const bool short_out = name == "-o" && app.get_option_no_throw("--out") != nullptr;
  throw UsageError("unknown option '" + name + "'." +
                   suggestion(short_out ? "--out" : name, option_names(app)) + " See `" + help +
                   " --help`.");
}

/// "raymoval clean": the command that was being parsed.
std::string parsed_command(const CLI::App& program) {
  const std::vector<CLI::App*> commands = program.get_subcommands();
  return program.get_name() + (commands.empty() ? "" : " " + commands.front()->get_name());
}

/// The parser's message. Plain words replace "--output: 1 required FILE missing" (an option without
/// a value) and "--frames: At Most 1 required but received 2".
std::string parse_problem(const CLI::ParseError& error) {
  constexpr std::string_view kRequired = ": 1 required ";
  constexpr std::string_view kMissing = " missing";
  constexpr std::string_view kTooMany = ": At Most 1 required but received ";
  const std::string text = error.what();
  if (const std::size_t often = text.find(kTooMany); often != std::string::npos) {
    return text.substr(0, often) + " is given " + text.substr(often + kTooMany.size()) +
           " times; leave all but one out.";
  }
  const std::size_t at = text.find(kRequired);
  if (at == std::string::npos || !text.ends_with(kMissing)) return text;
  const std::size_t type = at + kRequired.size();
  return text.substr(0, at) + ": " + text.substr(type, text.size() - kMissing.size() - type) +
         " is missing after it.";
}

std::string chosen_command(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command : all_commands(program)) {
    if (command->parsed()) {
      check_nothing_left(*command, program.get_name() + " " + command->get_name());
      check_nothing_left(program, program.get_name());
      return command->get_name();
    }
    if (!command->get_group().empty()) names.push_back(command->get_name());
  }
  const std::vector<std::string> left = program.remaining();
  if (left.empty()) throw UsageError("a command is missing: " + join(names) + ".");
  if (left.front().starts_with("-")) check_nothing_left(program, program.get_name());
  if (!closest_name(left.front(), names)) {
    const auto option = closest_name(left.front(), option_names(program));
    if (option) names = {*option};  // "version"
  }
  throw UsageError("'" + left.front() + "' is not a command." + suggestion(left.front(), names) +
                   " See `" + program.get_name() + " --help`.");
}

/// Help with the name of this program in place of `raymoval` before each command.
std::string with_own_name(const CLI::App& program, std::string text) {
  constexpr std::string_view kName = "raymoval";
  for (const CLI::App* command : all_commands(program)) {
    const std::string from = std::string(kName) + " " + command->get_name();
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += from.size()) {
      text.replace(at, kName.size(), program.get_name());
    }
  }
  return text;
}

}  // namespace

void CommandOptions::add(const std::string& names, const std::string& type, std::string& value,
                         const std::string& sentence) {
  app_of(command_).add_option(names, value, sentence)->type_name(type)->group(group_);
}

void CommandOptions::add(const std::string& names, const std::string& type,
                         std::vector<std::string>& values, const std::string& sentence) {
  // An option takes one value each time; words without an option are all values.
  const bool alone = !names.starts_with('-');
  app_of(command_)
      .add_option(names, values, sentence)
      ->type_name(type)
      ->allow_extra_args(alone)
      ->group(group_);
}

void CommandOptions::add_flag(const std::string& names, bool& value, const std::string& sentence) {
  app_of(command_).add_flag(names, value, sentence)->group(group_);
}

void CommandOptions::set_sentence(const std::string& name, const std::string& sentence) {
  app_of(command_).get_option(name)->description(sentence);
}

void CommandOptions::set_footer(const std::string& text) {
  app_of(command_).footer(text);
}

void CommandOptions::hide() {
  app_of(command_).group("");
}

struct CommandParser::Parser {
  CLI::App app;
  std::string answer = {};
};

CommandParser::CommandParser(const std::string& sentence, const std::string& name)
    : parser_(new Parser{CLI::App(sentence, name)}) {
  parser_->app.allow_extras();
  parser_->app.require_subcommand(0, 1);  // Not more, so that a run folder may be called "run".
}

CommandParser::~CommandParser() = default;

void CommandParser::set_version(const std::string& text) {
  parser_->app.set_version_flag("--version", text);
}

void CommandParser::set_footer(const std::string& text) {
  parser_->app.footer(text);
}

CommandOptions CommandParser::add_command(const std::string& name, const std::string& sentence) {
  CLI::App* command = parser_->app.add_subcommand(name, sentence);
  command->allow_extras();  // `check_nothing_left` reports the extras with better errors.
  return {command, name};
}

std::string CommandParser::parse(int argc, const char* const* argv) {
  CLI::App& program = parser_->app;
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      std::ostringstream text;
      program.exit(error, text, text);
      parser_->answer = with_own_name(program, text.str());
      return "";
    }
    throw UsageError(parse_problem(error) + " See `" + parsed_command(program) + " --help`.");
  }
  return chosen_command(program);
}

const std::string& CommandParser::answer() const {
  return parser_->answer;
}

std::string CommandParser::help_page(const std::string& command) const {
  const CLI::App& program = parser_->app;
  const auto& formatter = *program.get_formatter();
  const auto page = [&](const CLI::App* app, const std::string& name) {
    return with_own_name(program, formatter.make_help(app, name, CLI::AppFormatMode::Normal));
  };
  if (command.empty()) return page(&program, program.get_name());
  std::vector<std::string> names;
  for (const CLI::App* app : all_commands(program)) {
    if (app->get_group().empty()) continue;  // Not shown.
    if (app->get_name() == command) return page(app, program.get_name() + " " + command);
    names.push_back(app->get_name());
  }
  throw UsageError("'" + command + "' is not a command." + suggestion(command, names));
}

}  // namespace raymoval
