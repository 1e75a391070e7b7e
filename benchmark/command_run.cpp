// SPDX-License-Identifier: MIT
#include <memory>
#include <nlohmann/json.hpp>

#include "benchmark/commands.h"
#include "benchmark/runner.h"
#include "benchmark/shipped_suites.h"
#include "core/files.h"
#include "core/text.h"

namespace raymoval {
namespace {

struct RunFlags {
  std::string suite, out, threads;
  std::vector<std::string> sequences, methods, settings, protocols;
  SequenceFlags sequence;
  bool keep_removals = false;
  bool quiet = false;
};

/// What a suite file says cannot be said on the command line as well.
void check_suite_alone(const RunFlags& flags) {
  std::string given = flags.sequence.first_given();
  if (!flags.protocols.empty()) given = "--protocol";
  if (!flags.methods.empty()) given = "--method";
  if (!flags.sequences.empty()) given = "--sequence";
  if (given.empty()) return;
  throw UsageError(given + " cannot be given together with the suite file " + flags.suite +
                   "; write it into the file, or leave the file out.");
}

Suite suite_from_flags(const RunFlags& flags, const MethodRegistry& registry) {
  if (flags.sequences.empty()) {
    throw UsageError("nothing to run on: name a suite file, or a folder with --sequence PATH.");
  }
  if (flags.methods.empty()) {
    throw UsageError(
        "nothing to run: name a method with --method NAME[:variant] "
        "(see `raymoval list methods`).");
  }
  if (flags.sequences.size() > 1 && !flags.sequence.name.empty()) {
    throw UsageError("--name names one sequence, but there are " +
                     std::to_string(flags.sequences.size()) + "; use a suite file.");
  }
  Suite suite;
  const SequenceOptions options = flags.sequence.options();
  for (const std::string& path : flags.sequences) suite.sequences.push_back({path, options});
  for (const std::string& method : flags.methods) add_method(suite, method, "", registry);
  for (const std::string& protocol : flags.protocols) add_protocol(suite, protocol, "");
  return suite;
}

Suite resolved_suite(const RunFlags& flags) {
  const MethodRegistry& registry = MethodRegistry::built_in();
  if (!flags.suite.empty()) check_suite_alone(flags);
  Suite suite = flags.suite.empty() ? suite_from_flags(flags, registry)
                                    : read_suite(find_suite(flags.suite), registry);
  std::vector<Setting> settings;
  for (const std::string& text : flags.settings) settings.push_back(parse_setting(text));
  apply_settings(suite, settings);
  if (suite.protocols.empty()) add_protocol(suite, "erasor", "");
  if (suite.controls) add_controls(suite, registry);
  if (const int threads = parse_threads(flags.threads); threads > 0) suite.threads = threads;
  return suite;
}

void tell_problems(const RunSummary& summary) {
  for (const std::string& failure : summary.failures) {
    std::fprintf(stderr, "raymoval: cell failed: %s\n", failure.c_str());
  }
  for (const std::string& problem : summary.controls) {
    std::fprintf(stderr, "raymoval: controls are off: %s\n", problem.c_str());
  }
}

ExitCode run(const RunFlags& flags) {
  if (flags.out.empty()) {
    throw UsageError("--out DIR is missing: name the folder that is to hold the results.");
  }
  const Suite suite = resolved_suite(flags);
  Progress progress(flags.quiet ? ProgressStyle::kQuiet : progress_style_of_stderr());
  const RunOptions options{flags.out, flags.keep_removals, &progress, &interrupt_flag()};
  RunSummary summary;
  try {
    summary = run_suite(suite, options);
  } catch (const Cancelled&) {
    progress.end();
    std::fputs(
        "raymoval: cancelled. Finished cells are kept; the same command goes on with the "
        "rest.\n",
        stderr);
    return ExitCode::kWorse;
  } catch (...) {
    progress.end();
    throw;
  }
  progress.end();
  print(read_text(options.out / "table.md"));
  tell_problems(summary);
  return summary.good() ? ExitCode::kDone : ExitCode::kWorse;
}

}  // namespace

Command add_run_command(CLI::App& program) {
  auto flags = std::make_shared<RunFlags>();
  CLI::App* app = program.add_subcommand("run", "Runs methods on sequences and scores them");
  app->allow_extras();
  app->add_option("suite", flags->suite,
                  "Suite file (JSON, comments allowed), or name of a shipped suite")
      ->type_name("SUITE");
  app->add_option("--sequence", flags->sequences, "Sequence folder, ROOT:05, `street`, or a scene")
      ->type_name("PATH")
      ->allow_extra_args(false);
  app->add_option("--method", flags->methods, "Method to run, NAME or NAME:variant")
      ->type_name("NAME")
      ->allow_extra_args(false);
  app->add_option("--set", flags->settings, "Parameter: METHOD.key=value or METHOD:variant.key=...")
      ->type_name("SETTING")
      ->allow_extra_args(false);
  app->add_option("--protocol", flags->protocols, "Protocol to score by (default: erasor)")
      ->type_name("NAME")
      ->allow_extra_args(false);
  flags->sequence.add_to(*app);
  app->add_option("--threads", flags->threads, "At most so many threads (default: all cores)");
  app->add_option("--out", flags->out, "Folder for the results")->type_name("DIR");
  app->add_flag("--keep-removals", flags->keep_removals, "Keep what each method removed, per scan");
  app->add_flag("--quiet", flags->quiet, "No progress");
  app->footer(
      "The controls noop, remove-all and oracle are added and checked. A cell that is there "
      "already "
      "is not run again.\nExamples:\n"
      "  raymoval run --sequence street --method raymoval:online --out out/street\n"
      "  raymoval run --sequence data/05 --frames 0:100 --method raymoval --set raymoval.tau0=0.2 "
      "--out out/05\n"
      "  raymoval run --sequence town:scans=60,seed=3 --method raymoval:online --out out/town\n"
      "  raymoval run simulated --out out/simulated\n"
      "  raymoval run suite.json --out out/suite --threads 2");
  return {app, [flags] { return run(*flags); }};
}

}  // namespace raymoval
