// SPDX-License-Identifier: MIT
#include <memory>
#include <optional>

#include "benchmark/cli/command.h"
#include "benchmark/cli/suite_flags.h"
#include "benchmark/process/method_process.h"
#include "benchmark/result/results.h"
#include "benchmark/result/run_record_json.h"
#include "benchmark/run/plan.h"
#include "benchmark/run/runner.h"
#include "benchmark/tables/run_summary.h"
#include "core/files/files.h"
#include "core/terminal_colour.h"
#include "core/text.h"

namespace raymoval {
namespace {

struct RunFlags {
  SuiteFlags what;
  std::string out, cell, jobs;
  RunOptions options;  ///< Options that are stored as they are.
  bool explain = false, in_process = false, quiet = false;
};

void report_problems(const RunSummary& summary, bool collect) {
  for (const std::string& failure : summary.failures) {
    print_error(in_red("raymoval: cell failed:", stderr) + " " + failure);
  }
  for (const std::string& line : summary.lost_scans) print_warning(line);
  for (const std::string& problem : summary.controls) {
    print_error(in_red("raymoval: controls have wrong scores:", stderr) + " " + problem);
  }
  if (collect && !summary.missing.empty()) {
    print_error("raymoval: cells are missing: " + join(summary.missing));
  }
}

/// How many cells run at once; 1 by default.
int parse_jobs(const std::string& text) {
  return text.empty() ? 1 : parse_whole("--jobs", text, 1, 1024);
}

/// @throws UsageError if --out is missing, or for options that exclude each other
void check_flags(const RunFlags& flags) {
  if (flags.out.empty()) {
    throw UsageError("--out DIR is missing: name the folder for the results.");
  }
  const bool collect = flags.options.collect;
  const bool selects = !flags.options.only.empty();
  if (!flags.cell.empty() && (selects || collect || flags.explain)) {
    throw UsageError("--cell cannot be combined with --only, --collect and --explain.");
  }
  if (parse_jobs(flags.jobs) > 1 && flags.in_process) {
    throw UsageError("--jobs runs each method in a process of its own: leave --in-process out.");
  }
  if (parse_jobs(flags.jobs) > 1 && !flags.cell.empty()) {
    throw UsageError("--cell runs one cell: leave --jobs out.");
  }
  if (collect && selects) {
    throw UsageError("--collect gathers all cells: leave out --only.");
  }
}

ExitCode explain(const Suite& suite, const RunOptions& options) {
  std::string text;
  std::size_t to_run = 0;
  const SuitePlan plan = plan_suite(suite, options);
  for (const PlannedCell& cell : plan.cells) {
    to_run += cell.to_run ? 1 : 0;
    text += (cell.to_run ? "run   " : "keep  ") + cell.cell.title() +
            (cell.why.empty() ? "" : ": " + cell.why) + "\n";
  }
  for (const CellName& cell : plan.earlier) {
    text += "keep  " + cell.title() + ": of an earlier run\n";
  }
  for (const std::string& cell : plan.left_out) text += "leave out of the tables  " + cell + "\n";
  options.progress->end();
  text += std::to_string(to_run) + " of " + std::to_string(plan.cells.size()) +
          " cells are to be run.\n";
  if (!plan.refused.empty()) text += "But the run is refused: " + plan.refused + "\n";
  print(text);
  return ExitCode::kDone;
}

/// Runs the suite or one cell; nothing if it was cancelled.
std::optional<RunSummary> run_asked(const RunFlags& flags, const Suite& suite,
                                    const RunOptions& options) {
  try {
    return flags.cell.empty() ? run_suite(suite, options)
                              : run_one_cell(suite, options, flags.cell);
  } catch (const Cancelled&) {
    options.progress->end();
    print_error("raymoval: cancelled. Finished cells are kept; the same command runs the rest.");
    return std::nullopt;
  } catch (...) {
    options.progress->end();
    throw;
  }
}

/// A summary of the run folder, in one screen.
std::string end_of_run(const std::string& out) {
  const std::filesystem::path file = std::filesystem::path(out) / "results.json";
  return run_summary(shown_results(read_results(file)), out);
}

ExitCode run(const RunFlags& flags) {
  if (flags.what.suite.empty() && flags.what.sequences.empty()) {
    throw UsageError(
        "SUITE is missing: expected `raymoval run SUITE --out DIR`, or `raymoval run --sequence "
        "PATH --method NAME --out DIR`.");
  }
  const Suite suite = flags.what.resolved();
  check_flags(flags);
  warn_of_settings_without_effect(suite);
  Progress progress(progress_style(flags.quiet));
  RunOptions options = flags.options;
  options.out = flags.out;
  options.progress = &progress;
  options.cancel = &interrupt_flag();
  options.isolate = !flags.in_process;
  options.jobs = parse_jobs(flags.jobs);
  if (flags.explain) return explain(suite, options);
  const auto summary = run_asked(flags, suite, options);
  if (!summary) return ExitCode::kWorse;
  progress.end();
  if (flags.cell.empty()) print(end_of_run(flags.out));
  report_problems(*summary, options.collect);
  const bool whole = !options.collect || summary->missing.empty();
  return summary->good() && whole ? ExitCode::kDone : ExitCode::kWorse;
}

/// The options for choosing and keeping cells.
void add_cell_options(CommandOptions& options, RunFlags& flags) {
  options.group("Cell options");
  options.add(
      "--only", "PATTERN", flags.options.only,
      "Run only the cells whose SEQUENCE/NAME, SEQUENCE or NAME matches this pattern (* and ?)");
  options.add(
      "--cell", "CELL", flags.cell,
      "Run one cell, given by its key (see `raymoval plan`) or as SEQUENCE/NAME; make no tables");
  options.add_flag("--collect", flags.options.collect,
                   "Run nothing; make the tables of the finished cells");
  options.add_flag("--explain", flags.explain,
                   "Run no method; list the cells that would run, and why. Scenes that are not in "
                   "the cache are simulated first");
}

void add_options(CommandOptions& options, RunFlags& flags) {
  flags.what.add_to(options);
  options.add("--jobs", "N", flags.jobs,
              "Run N cells in parallel, each with one thread (default: 1). Their times are marked, "
              "since each cell is slower than alone");
  add_cell_options(options, flags);
  options.group("Result options");
  options.add("--out", "DIR", flags.out, "The folder for the results");
  options.add_flag("--keep-removals", flags.options.keep_removals,
                   "Store which points each method removed from each scan");
  options.add_flag("--confidence", flags.options.confidence,
                   "Also store and score the confidence of each point, for methods that have one "
                   "(see `raymoval describe METHOD`)");
  options.add_flag("--overwrite", flags.options.overwrite,
                   "Replace results in the folder that are of another suite or other data");
  options.group("Other options");
  options.add_flag("--in-process", flags.in_process,
                   "Run methods in this process, for a debugger; a crash then ends the whole run");
  options.add_flag("--quiet", flags.quiet, "Show no progress");
}

}  // namespace

Command add_run_command(CommandParser& program) {
  auto flags = std::make_shared<RunFlags>();
  CommandOptions options = program.add_command("run", "Runs methods on sequences and scores them");
  add_options(options, *flags);
  options.set_footer(
      "The controls noop, remove-all and oracle are added and checked. Each method runs in its "
      "own\n"
      "process. If it crashes or exceeds a limit, the "
      "cell fails and the run continues. The --out folder is marked with .raymoval-run; only files "
      "of the\n"
      "run itself are ever deleted in it.\n"
      "\n"
      "With --jobs N, N cells run in parallel, each with one thread and, without --memory-limit, "
      "an Nth\n"
      "of the memory. Only times change. cell.json and run.json record N, and `raymoval compare` "
      "does not\n"
      "compare such times with others. To measure times, leave --jobs out.\n"
      "\n"
      "A folder holds the results of one suite. Finished cells are kept, and new methods or "
      "sequences are\n"
      "added to the tables. If the parameters or the version of a method changed, the selected "
      "cells run\n"
      "again, and its other cells are left out of the tables, with a message; cells of methods "
      "that are\n"
      "not in this run stay. A run is refused if its suite has another name than that of the "
      "folder, if\n"
      "it scores by other protocols or options, or if a sequence of the same name has other data "
      "(frames,\n"
      "poses, sensor, range, labels, scans). With --overwrite such a run replaces the tables: they "
      "then\n"
      "have the cells of this run only.\n"
      "Examples:\n"
      "  raymoval run --sequence street --method raymoval:online --keep-removals --out out/street\n"
      "  raymoval run --sequence data/05 --frames 0:100 --method raymoval:offline --keep-removals "
      "--out out/05\n"
      "  raymoval run --sequence data/05 --method raymoval --set raymoval.voxel_size=0.1 --out "
      "out/fine\n"
      "  raymoval run --sequence street --method raymoval --protocol dynamicmap --set "
      "protocol:dynamicmap.maximum_range=50 --out out/near\n"
      "  raymoval run --sequence town:scans=60,seed=3 --method raymoval:online --out out/town\n"
      "  raymoval run --sequence town:scans=60,seed=3 --method octomap --out out/town  # is added\n"
      "  raymoval run data/05 --method all --method octomap:all --out out/all\n"
      "  raymoval run simulated --out out/simulated\n"
      "  raymoval run simulated --out out/simulated --explain\n"
      "  raymoval run simulated --out out/soon --jobs 2\n"
      "  raymoval run suite.json --out out/suite --threads 2 --only 'town/raymoval:*'");
  return {options.name(), [flags] { return run(*flags); }};
}

Command add_run_method_command(CommandParser& program) {
  CommandOptions options = program.add_command(kMethodCommand, "");
  options.hide();
  return {options.name(), [] {
            serve_method(program_methods());
            return ExitCode::kDone;
          }};
}

}  // namespace raymoval
