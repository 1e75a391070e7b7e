// SPDX-License-Identifier: MIT
#include <memory>
#include <nlohmann/json.hpp>

#include "benchmark/cli/commands.h"
#include "benchmark/cli/commands/output_json.h"
#include "benchmark/cli/suite_flags.h"

namespace raymoval {
namespace {

struct PlanFlags {
  SuiteFlags what;
  std::string out;
  bool quiet = false;
};

/// A JSON value on a line of its own.
std::string line_of(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

ExitCode plan(const PlanFlags& flags) {
  const Suite suite = flags.what.resolved();
  warn_of_settings_without_effect(suite);
  Progress progress(flags.quiet ? ProgressStyle::kQuiet : progress_style_of_stderr());
  RunOptions options;
  options.out = flags.out;
  options.progress = &progress;
  options.cancel = &interrupt_flag();
  const std::vector<PlannedCell> cells = plan_suite(suite, options).cells;
  progress.end();
  std::string text;
  for (const PlannedCell& cell : cells) text += line_of(to_json(cell, !flags.out.empty()));
  print(text);
  return ExitCode::kDone;
}

}  // namespace

Command add_plan_command(CLI::App& program) {
  auto flags = std::make_shared<PlanFlags>();
  CLI::App* app = program.add_subcommand("plan", "Prints the cells of a suite, a JSON line each");
  app->allow_extras();
  flags->what.add_to(*app);
  app->add_option("--out", flags->out, "Run folder: also tell which cells are to be run, and why")
      ->type_name("DIR");
  app->add_flag("--quiet", flags->quiet, "No progress");
  app->footer(
      "Each cell may be run on a machine of its own: raymoval run SUITE --out DIR --cell KEY.\n"
      "Then raymoval run SUITE --out DIR --collect makes the tables.\n"
      "Examples:\n"
      "  raymoval plan simulated-quick\n"
      "  raymoval plan suite.json --out out/suite");
  return {app, [flags] { return plan(*flags); }};
}

}  // namespace raymoval
