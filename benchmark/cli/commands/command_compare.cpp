// SPDX-License-Identifier: MIT
#include <memory>
#include <system_error>

#include "benchmark/cli/command.h"
#include "benchmark/result/checks/result_sets.h"
#include "benchmark/run/folder/run_folder.h"
#include "benchmark/tables/comparison_files.h"
#include "core/files/file_kind.h"
#include "core/files/file_writer.h"
#include "core/files/files.h"
#include "core/text.h"

namespace raymoval {
namespace {

struct CompareFlags {
  std::string run, reference, time_band, format = "text";
  OutputFlag output;
  std::vector<std::string> tolerances, across;
  bool update = false, with_times = false;
};

/// `--across parameters,version`, or each on its own.
void read_across(const std::vector<std::string>& given, ComparisonOptions& options) {
  for (const std::string& text : given) {
    for (const std::string_view word : split(text, ',')) {
      if (word == "parameters") {
        options.across_parameters = true;
      } else if (word == "version") {
        options.across_version = true;
      } else {
        throw UsageError("--across " + text + ": expected what may differ." +
                         suggestion(word, {"parameters", "version"}));
      }
    }
  }
}

ComparisonOptions options_of(const CompareFlags& flags) {
  ComparisonOptions options;
  for (const std::string& text : flags.tolerances) {
    const std::size_t equals = text.find('=');
    const auto value = equals == std::string::npos
                           ? std::nullopt
                           : parse_number<double>(std::string_view(text).substr(equals + 1));
    if (equals == 0 || !value || !(*value >= 0.0 && *value <= 100.0)) {
      throw UsageError(
          "--tolerance " + text +
          ": expected METRIC=NUMBER from 0 to 100 in the metric's own unit, such as F1=0.002 or "
          "PR=0.1.");
    }
    if (!options.tolerances.emplace(text.substr(0, equals), *value).second) {
      throw UsageError("--tolerance gives " + text.substr(0, equals) + " twice; leave one out.");
    }
  }
  read_across(flags.across, options);
  if (flags.time_band.empty()) return options;
  options.time_band = parse_positive("--time-band", flags.time_band);
  if (*options.time_band < 1.0) {
    throw UsageError("--time-band " + flags.time_band +
                     ": expected a factor of at least 1, such as 3.");
  }
  return options;
}

/// The path of the reference file to write; its folder is made.
std::filesystem::path reference_file(const std::string& reference) {
  const std::filesystem::path given(reference);
  const std::filesystem::path file = given.extension() == ".json" ? given : given / "results.json";
  if (!file.has_parent_path()) return file;
  const std::error_code error = make_folders(file.parent_path());
  if (error) {
    throw DataError(file.parent_path().string() + ": cannot be made (" + error.message() + ").");
  }
  return file;
}

ExitCode update(const CompareFlags& flags) {
  if (!flags.tolerances.empty() || !flags.across.empty() || !flags.time_band.empty() ||
      !flags.output.path.empty()) {
    throw UsageError(
        "--update compares nothing: leave --tolerance, --across, --time-band and -o out.");
  }
  const std::filesystem::path run = find_results(flags.run);
  const std::filesystem::path file = reference_file(flags.reference);
  if (is_record_of_run(file)) {
    throw UsageError(file.string() +
                     ": is a record of a run and cannot be replaced by a reference. Name another "
                     "folder or file for the reference.");
  }
  write_reference(run, file, flags.with_times);
  print("wrote " + file.string() +
        (flags.with_times
             ? " with its times. They are valid on this machine only.\n"
             : " without times: --time-band cannot be used with it (--with-times keeps them).\n"));
  return ExitCode::kDone;
}

/// The exit code of the comparison. The output already lists the problems.
ExitCode judged(const Comparison& comparison, const ComparisonOptions& options) {
  if (comparison.verdict() == ExitCode::kCannotDo) {
    const bool hint = comparison.parameters_only && !options.across_parameters;
    throw UsageError(
        std::string("the results are not comparable, see above.") +
        (hint ? " Only parameters differ: --across parameters compares the rates." : ""));
  }
  if (comparison.verdict() == ExitCode::kWorse) {
    throw Error("the run is worse than the reference, see above.", ExitCode::kWorse);
  }
  return ExitCode::kDone;
}

ExitCode compare(const CompareFlags& flags) {
  if (flags.run.empty() || flags.reference.empty()) {
    throw UsageError("two results are needed: expected `raymoval compare RUN REFERENCE`.");
  }
  if (flags.with_times && !flags.update) {
    throw UsageError("--with-times needs --update: it keeps the times in the new reference.");
  }
  if (flags.update) return update(flags);
  const ComparisonSubject subject{flags.run, flags.reference};
  const ComparisonOptions options = options_of(flags);
  (void)comparison_in(flags.format, {}, subject);  // A wrong format is reported before the work.
  flags.output.check();
  const std::filesystem::path run = find_results(flags.run);
  const std::filesystem::path reference = find_results(flags.reference);
  flags.output.check_is_none_of({run, reference});
  const Comparison comparison =
      compare_results(read_result_set(run), read_result_set(reference), options);
  const std::string text = comparison_in(flags.format, comparison, subject);
  flags.output.write(text);
  const bool shows_text = !flags.output.path.empty() || flags.format == "text";
  print(shows_text ? comparison_text(comparison) : text);
  return judged(comparison, options);
}

void add_compare_options(CommandOptions& options, CompareFlags& flags) {
  options.add("run", "RUN", flags.run, "Run folder, or its results.json");
  options.add("reference", "REFERENCE", flags.reference,
              "The run folder, or results.json, to compare with");
  options.add(
      "--tolerance", "TOLERANCE", flags.tolerances,
      "METRIC=NUMBER: this rate may get worse by at most NUMBER, in its own unit, and counts "
      "may differ; F1=0.01 allows F1 to fall by at most 0.01");
  options.add(
      "--across", "WHAT", flags.across,
      "What may differ: parameters or version of methods, or both (parameters,version). Cells "
      "that differ in it are compared by their rates");
  options.add(
      "--time-band", "FACTOR", flags.time_band,
      "A method that is slower than the reference by more than this factor is worse (default: "
      "times are shown and not compared)");
  options.add("--format", "FORMAT", flags.format, "text, md or junit (default: text)");
  flags.output.add_to(options, "-o,--output",
                      "Write the comparison to this file, and print it as text");
  options.add_flag("--update", flags.update,
                   "Make RUN the new REFERENCE, without times and machine; compare nothing");
  options.add_flag("--with-times", flags.with_times,
                   "With --update: keep times and machine, for --time-band");
}

}  // namespace

Command add_compare_command(CommandParser& program) {
  auto flags = std::make_shared<CompareFlags>();
  CommandOptions options =
      program.add_command("compare", "Compares a run with a reference, and fails if it got worse");
  add_compare_options(options, *flags);
  options.set_footer(
      "Counts must be equal. Runs with other data, protocols or parameters cannot be compared. "
      "With\n"
      "--tolerance the named rates decide, in the protocols that have them. Each protocol defines\n"
      "which direction of a rate is better.\n"
      "Use --across parameters after a change of defaults: cells whose parameters differ are "
      "compared\n"
      "by their rates. No rate may get worse by more than its tolerance (or at all, if no rate of "
      "the\n"
      "protocol has a tolerance). The output lists what differs.\n"
      "--format junit is XML for a CI server: a test suite for each sequence, and a test case for\n"
      "each method and protocol.\n"
      "Times of cells that ran in parallel (run --jobs) are compared only if equally many ran at "
      "once.\n"
      "Exit codes: 0 the same or better, 1 worse, 2 not comparable.\n"
      "Examples:\n"
      "  raymoval run quick --out out/quick\n"
      "  raymoval compare out/quick results/reference/street\n"
      "  raymoval compare out/new out/old --tolerance F1=0.002 --time-band 3\n"
      "  raymoval compare out/new out/old --across parameters --tolerance F1=0.01\n"
      "  raymoval compare out/new out/old --format junit -o compare.xml\n"
      "  raymoval compare out/new reference --update --with-times");
  return {options.name(), [flags] { return compare(*flags); }};
}

}  // namespace raymoval
