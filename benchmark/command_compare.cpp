// SPDX-License-Identifier: MIT
#include <memory>

#include "benchmark/commands.h"
#include "benchmark/result_sets.h"
#include "benchmark/terminal_colour.h"
#include "core/text.h"

namespace raymoval {
namespace {

struct CompareFlags {
  std::string run, reference, time_band;
  std::vector<std::string> tolerances;
  bool update = false;
};

ComparisonOptions options_of(const CompareFlags& flags) {
  ComparisonOptions options;
  for (const std::string& text : flags.tolerances) {
    const std::size_t equals = text.find('=');
    const auto value = equals == std::string::npos
                           ? std::nullopt
                           : parse_number<double>(std::string_view(text).substr(equals + 1));
    if (equals == 0 || !value || !(*value >= 0.0 && *value <= 100.0)) {
      throw UsageError("--tolerance " + text +
                       ": expected METRIC=NUMBER from 0 to 100, such as F1=0.002 or PR=0.1.");
    }
    if (!options.tolerances.emplace(text.substr(0, equals), *value).second) {
      throw UsageError("--tolerance gives " + text.substr(0, equals) + " twice; leave one out.");
    }
  }
  if (flags.time_band.empty()) return options;
  options.time_band = parse_positive("--time-band", flags.time_band);
  if (*options.time_band < 1.0) {
    throw UsageError("--time-band " + flags.time_band +
                     ": expected a factor of at least 1, such as 3.");
  }
  return options;
}

/// `reference` as the file that is to be written; its folder is made.
std::filesystem::path reference_file(const std::string& reference) {
  const std::filesystem::path given(reference);
  const std::filesystem::path file = given.extension() == ".json" ? given : given / "results.json";
  if (!file.has_parent_path()) return file;
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  if (error) {
    throw DataError(file.parent_path().string() + ": cannot be made (" + error.message() + ").");
  }
  return file;
}

std::string coloured_verdicts(const std::string& text) {
  return coloured_phrases(text,
                          {{"Worse", TerminalColour::kBad},
                           {"worse", TerminalColour::kBad},
                           {"Better", TerminalColour::kGood},
                           {"better, no regression", TerminalColour::kGood},
                           {"no regression", TerminalColour::kGood},
                           {"Not comparable", TerminalColour::kNotice},
                           {"not comparable", TerminalColour::kNotice}},
                          stdout);
}

ExitCode compare(const CompareFlags& flags) {
  if (flags.run.empty() || flags.reference.empty()) {
    throw UsageError("two results are needed: expected `raymoval compare RUN REFERENCE`.");
  }
  const ComparisonOptions options = options_of(flags);
  const std::filesystem::path run = find_results(flags.run);
  if (flags.update) {
    const std::filesystem::path file = reference_file(flags.reference);
    write_reference(run, file);
    print("wrote " + file.string() + "\n");
    return ExitCode::kDone;
  }
  const Comparison comparison = compare_results(
      read_result_set(run), read_result_set(find_results(flags.reference)), options);
  print(coloured_verdicts(comparison_text(comparison)));
  if (comparison.verdict() == ExitCode::kCannotDo) {
    throw UsageError("the results are not comparable: " + comparison.incomparable.front() + ".");
  }
  if (comparison.verdict() == ExitCode::kWorse) {
    throw Error("worse than the reference: " + comparison.worse.front() + ".", ExitCode::kWorse);
  }
  return ExitCode::kDone;
}

}  // namespace

Command add_compare_command(CLI::App& program) {
  auto flags = std::make_shared<CompareFlags>();
  CLI::App* app = program.add_subcommand("compare", "Tells whether a run got worse");
  app->allow_extras();
  app->add_option("run", flags->run, "Run folder, or its results.json")->type_name("RUN");
  app->add_option("reference", flags->reference, "What it is compared with: the same")
      ->type_name("REFERENCE");
  app->add_option("--tolerance", flags->tolerances,
                  "METRIC=NUMBER: judge this rate, which may fall so far, instead of the counts")
      ->type_name("TOLERANCE")
      ->allow_extra_args(false);
  app->add_option("--time-band", flags->time_band,
                  "Slower than the reference by more than this factor is worse (default: times are "
                  "shown, never judged)")
      ->type_name("FACTOR");
  app->add_flag("--update", flags->update,
                "Make RUN the new REFERENCE, without times and machine; compare nothing");
  app->footer(
      "Counts must be equal; other data, protocols or parameters are not comparable.\n"
      "Exit codes: 0 the same or better, 1 worse, 2 not comparable.\nExamples:\n"
      "  raymoval run quick --out out/quick\n"
      "  raymoval compare out/quick results/reference/street\n"
      "  raymoval compare out/new out/old --tolerance F1=0.002 --time-band 3");
  return {app, [flags] { return compare(*flags); }};
}

}  // namespace raymoval
