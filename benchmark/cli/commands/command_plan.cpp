// SPDX-License-Identifier: MIT
#include <memory>

#include "benchmark/cli/command.h"
#include "benchmark/cli/suite_flags.h"
#include "benchmark/result/record_fields.h"
#include "benchmark/run/plan.h"

namespace raymoval {
namespace {

struct PlanFlags {
  SuiteFlags what;
  std::string out;
  bool quiet = false;
};

/// A line of JSON. @param looked whether the run folder was read
std::string planned_line(const PlannedCell& cell, bool looked) {
  RecordWriter writer;
  writer.field("cell", cell.cell.sequence + "/" + cell.cell.name);
  writer.nullable("key", cell.key);
  writer.field("sequence", cell.cell.sequence);
  writer.field("name", cell.cell.name);
  writer.field("method", cell.method);
  writer.field("scans", cell.scans);
  writer.field("folder", cell.folder.generic_string());
  if (looked) writer.field("to_run", cell.to_run);
  if (looked) writer.field("why", cell.why);
  return writer.json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

ExitCode plan(const PlanFlags& flags) {
  const Suite suite = flags.what.resolved();
  warn_of_settings_without_effect(suite);
  Progress progress(progress_style(flags.quiet));
  RunOptions options;
  options.out = flags.out;
  options.progress = &progress;
  options.cancel = &interrupt_flag();
  const SuitePlan planned = plan_suite(suite, options);
  progress.end();
  if (!planned.refused.empty()) {
    throw UsageError("`raymoval run` would refuse this folder: " + planned.refused);
  }
  std::string text;
  for (const PlannedCell& cell : planned.cells) text += planned_line(cell, !flags.out.empty());
  print(text);
  return ExitCode::kDone;
}

}  // namespace

Command add_plan_command(CommandParser& program) {
  auto flags = std::make_shared<PlanFlags>();
  CommandOptions options =
      program.add_command("plan", "Prints a line of JSON for each cell of a suite");
  flags->what.add_to(options);
  options.group("Other options");
  options.add("--out", "DIR", flags->out,
              "The run folder: also list which cells have to run, and why. Fails if `raymoval run` "
              "would refuse the folder");
  options.add_flag("--quiet", flags->quiet, "Show no progress");
  options.set_footer(
      "Each cell can run on another machine: raymoval run SUITE --out DIR --cell KEY.\n"
      "Then raymoval run SUITE --out DIR --collect makes the tables.\n"
      "A key depends on all of the data. Scenes that are not in the cache are therefore simulated "
      "first,\n"
      "into $RAYMOVAL_CACHE, else ~/.cache/raymoval: about 100 MB each, and several GB for a large "
      "suite.\n"
      "Examples:\n"
      "  raymoval plan simulated-quick\n"
      "  raymoval plan suite.json --out out/suite");
  return {options.name(), [flags] { return plan(*flags); }};
}

}  // namespace raymoval
