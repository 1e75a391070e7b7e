// SPDX-License-Identifier: MIT
#include "benchmark/cli/command_line.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>

#include "benchmark/cli/commands.h"
#include "benchmark/cli/terminal_colour.h"
#include "benchmark/suite/amounts.h"
#include "core/files/file_kind.h"
#include "core/text.h"
#include "datasets/open_sequence.h"

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

/// Options and words that no command knows are kept by the parser; here they become an error that
/// names the nearest one known.
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

/// "raymoval clean": what was being read of the command line.
std::string parsed_command(const CLI::App& program) {
  const std::vector<CLI::App*> commands = program.get_subcommands();
  return "raymoval" + (commands.empty() ? "" : " " + commands.front()->get_name());
}

/// The parser's message, in plain words where it says "--output: 1 required FILE missing" of an
/// option without value, or "--frames: At Most 1 required but received 2".
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

const Command& chosen_command(const CLI::App& program, const std::vector<Command>& commands) {
  std::vector<std::string> names;
  for (const Command& command : commands) {
    if (command.app->parsed()) {
      check_nothing_left(*command.app, "raymoval " + command.app->get_name());
      check_nothing_left(program, "raymoval");
      return command;
    }
    if (!command.app->get_group().empty()) names.push_back(command.app->get_name());
  }
  const std::vector<std::string> left = program.remaining();
  if (left.empty()) throw UsageError("a command is missing: " + join(names) + ".");
  if (left.front().starts_with("-")) check_nothing_left(program, "raymoval");
  if (!closest_name(left.front(), names)) {
    const auto option = closest_name(left.front(), option_names(program));
    if (option) names = {*option};  // "version"
  }
  throw UsageError("'" + left.front() + "' is no command." + suggestion(left.front(), names) +
                   " See `raymoval --help`.");
}

ExitCode run_program(int argc, const char* const* argv) {
  CLI::App program("raymoval: evaluates the removal of moving objects from LiDAR maps.",
                   "raymoval");
  program.set_version_flag("--version", "raymoval " RAYMOVAL_VERSION);
  program.allow_extras();
  program.require_subcommand(0, 1);  // So that a run folder may be called "run".
  program.footer(
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
  const std::vector<Command> commands = {
      add_run_command(program),      add_plan_command(program),    add_run_method_command(program),
      add_table_command(program),    add_compare_command(program), add_list_command(program),
      add_describe_command(program), add_score_command(program),   add_clean_command(program),
      add_simulate_command(program), add_inspect_command(program), add_picture_command(program),
      add_report_command(program),   add_help_command(program),    add_completion_command(program)};
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      program.exit(error);
      return ExitCode::kDone;
    }
    throw UsageError(parse_problem(error) + " See `" + parsed_command(program) + " --help`.");
  }
  return chosen_command(program, commands).run();
}

EgoRegion parse_drop_ego(const std::string& text) {
  try {
    return parse_ego_region(text);
  } catch (const UsageError& error) {
    throw UsageError("--drop-ego " + std::string(error.what()));
  }
}

ExitCode tell(const std::string& message, ExitCode code) {
  std::fprintf(stderr, "%s %s\n", coloured("raymoval:", TerminalColour::kBad, stderr).c_str(),
               message.c_str());
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

void SequenceFlags::add_place_to(CLI::App& app, std::string& place) {
  app.add_option("path,--sequence", place, "Sequence folder, ROOT:05, `street`, or a scene")
      ->type_name("PATH");
}

void SequenceFlags::add_to(CLI::App& app) {
  app.add_option("--frames", frames, "Frames, ends included; parts may be empty")
      ->type_name("FIRST:LAST:STRIDE");
  app.add_option("--poses", poses, "Pose file: a name in the sequence folder, or a path")
      ->type_name("FILE");
  app.add_option("--label-rule", label_rule, "JSON file that says which labels move")
      ->type_name("FILE");
  app.add_option("--range", range,
                 "Metres; points beyond are not evaluated, but methods see them (see --drop-ego)")
      ->type_name("MIN:MAX");
  app.add_option("--sensor", sensor, "A known sensor (see `raymoval list sensors`), or estimated")
      ->type_name("NAME");
  app.add_option("--up", up, "Up in the world of the poses: z, -y, or x,y,z (default: estimated)")
      ->type_name("AXIS");
  app.add_option("--drop-ego", drop_ego,
                 "Leave out points of the own vehicle, so that no method sees them: auto "
                 "(estimated), a radius (2.4), or a box XMIN:XMAX,YMIN:YMAX,ZMIN:ZMAX of the "
                 "sensor frame")
      ->type_name("WHERE");
  app.add_option("--name", name, "Name of the sequence in results")->type_name("NAME");
}

std::string SequenceFlags::first_given() const {
  const std::pair<const char*, const std::string*> all[] = {
      {"--frames", &frames},     {"--poses", &poses},   {"--label-rule", &label_rule},
      {"--range", &range},       {"--sensor", &sensor}, {"--up", &up},
      {"--drop-ego", &drop_ego}, {"--name", &name}};
  for (const auto& [option, text] : all) {
    if (!text->empty()) return option;
  }
  return "";
}

SequenceOptions SequenceFlags::options() const {
  SequenceOptions options;
  if (!frames.empty()) options.frames = parse_frame_range(frames);
  if (!poses.empty()) options.poses = poses;
  if (!label_rule.empty()) options.label_rule = label_rule;
  if (!sensor.empty()) options.sensor = sensor;
  if (!up.empty()) options.up = up;
  if (!drop_ego.empty()) options.drop_ego = parse_drop_ego(drop_ego);
  if (!name.empty()) options.name = name;
  if (range.empty()) return options;
  options.range_m = parse_range("--range", range);
  return options;
}

int parse_threads(const std::string& text) {
  if (text.empty()) return 0;
  const auto value = parse_number<int>(text);
  if (value && *value >= 1 && *value <= 4096) return *value;
  throw UsageError("--threads " + text + ": expected a whole number from 1 to 4096.");
}

double parse_positive(const std::string& option, const std::string& text) {
  const auto value = parse_number<double>(text);
  if (value && *value > 0.0 && *value < 1e6) return *value;
  throw UsageError(option + " " + text +
                   ": expected a number greater than 0 and less than 1,000,000, without a unit.");
}

void print(const std::string& text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (!written || std::fflush(stdout) != 0) {
    throw DataError("standard output cannot be written (a full disk or a closed pipe?).");
  }
}

int run_command_line(int argc, const char* const* argv, const MethodRegistry& methods) {
  known_methods = &methods;
  given_arguments.assign(argv + std::min(argc, 1), argv + argc);
  // A file that outgrows its limit is then an error of writing, told like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  ExitCode code = ExitCode::kInternal;
  try {
    code = run_program(argc, argv);
  } catch (const InternalError& error) {
    code =
        tell(std::string("internal error, please report it: ") + error.what(), error.exit_code());
  } catch (const Error& error) {
    code = tell(error.what(), error.exit_code());
  } catch (const std::bad_alloc&) {
    code = tell("there was not enough memory. Choose fewer --frames.", ExitCode::kCannotDo);
  } catch (const std::exception& error) {
    code =
        tell(std::string("internal error, please report it: ") + error.what(), ExitCode::kInternal);
  }
  return static_cast<int>(code);
}

}  // namespace raymoval
