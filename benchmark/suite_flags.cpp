// SPDX-License-Identifier: MIT
#include "benchmark/suite_flags.h"

#include <algorithm>
#include <cstdio>

#include "benchmark/shipped_suites.h"
#include "core/error.h"
#include "datasets/frames.h"

namespace raymoval {
namespace {

/// What a path is that was given where a suite is expected; empty for what may be a suite.
std::string sequence_kind(const std::string& path) {
  const auto shipped = shipped_suite_names();
  const bool known = std::find(shipped.begin(), shipped.end(), path) != shipped.end();
  if (known || is_file(path)) return "";
  if (is_folder(path)) return "folder";
  if (is_scene(path)) return "scene";
  const std::size_t colon = path.rfind(':');
  return colon != std::string::npos && is_folder(path.substr(0, colon)) ? "sequence" : "";
}

/// Who forgets "--sequence" gives a folder or a scene for the suite.
void check_is_suite(const std::string& path) {
  const std::string kind = sequence_kind(path);
  if (kind.empty()) return;  // Whoever reads the suite says what else is wrong.
  throw UsageError(path + ": is a " + kind +
                   ", expected a suite file. To run on it: `raymoval run --sequence " + path +
                   " --method NAME --out DIR`.");
}

/// What a suite file says cannot be said on the command line as well.
void check_suite_alone(const SuiteFlags& flags) {
  std::string given = flags.sequence.first_given();
  if (!flags.protocols.empty()) given = "--protocol";
  if (!flags.methods.empty()) given = "--method";
  if (!flags.sequences.empty()) given = "--sequence";
  if (given.empty()) return;
  throw UsageError(given + " cannot be given together with the suite file " + flags.suite +
                   "; write it into the file, or leave the file out.");
}

Suite suite_from_flags(const SuiteFlags& flags, const MethodRegistry& registry) {
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
  for (const std::string& path : flags.sequences) {
    check_not_both(path);
    suite.sequences.push_back({path, options});
  }
  for (const std::string& method : flags.methods) add_method(suite, method, "", registry);
  for (const std::string& protocol : flags.protocols) add_protocol(suite, protocol, "");
  return suite;
}

}  // namespace

Suite SuiteFlags::resolved() const {
  const SuiteFlags& flags = *this;
  const MethodRegistry& registry = program_methods();
  std::vector<Setting> parsed;  // First: "--set KEY VALUE" leaves VALUE to be taken for a suite.
  for (const std::string& text : flags.settings) parsed.push_back(parse_setting(text));
  if (!flags.suite.empty()) {
    if (flags.sequences.empty()) check_is_suite(flags.suite);
    check_suite_alone(flags);
  }
  if (flags.suite.empty() && !data.empty()) {
    throw UsageError("--data goes with a suite file that names {data}; use --sequence.");
  }
  Suite made = flags.suite.empty() ? suite_from_flags(flags, registry)
                                   : read_suite(find_suite(flags.suite), registry, data);
  if (made.protocols.empty()) add_protocol(made, "erasor", "");
  apply_settings(made, parsed);
  if (made.controls) add_controls(made, registry);
  if (const int count = parse_threads(flags.threads); count > 0) made.threads = count;
  if (!time_limit.empty()) made.time_limit_s = parse_positive("--time-limit", time_limit);
  if (!memory_limit.empty()) {
    made.memory_limit_mib = parse_positive("--memory-limit", memory_limit);
  }
  return made;
}

void warn_of_settings_without_effect(const Suite& suite) {
  for (const std::string& line : settings_without_effect(suite)) {
    std::fprintf(stderr, "raymoval: warning: %s\n", line.c_str());
  }
}

void SuiteFlags::add_to(CLI::App& app) {
  app.add_option("suite", suite, "Suite file (JSON, comments allowed), or name of a shipped suite")
      ->type_name("SUITE");
  app.add_option("--data", data, "Root of the data set that the suite calls {data}")
      ->type_name("ROOT");
  app.add_option("--sequence", sequences, "Sequence folder, ROOT:05, `street`, or a scene")
      ->type_name("PATH")
      ->allow_extra_args(false);
  app.add_option("--method", methods, "Method to run, NAME or NAME:variant")
      ->type_name("NAME")
      ->allow_extra_args(false);
  app.add_option("--set", settings,
                 "Parameter: METHOD.key=value or METHOD:variant.key=...; option of a protocol: "
                 "protocol:NAME.key=...")
      ->type_name("SETTING")
      ->allow_extra_args(false);
  app.add_option("--protocol", protocols, "Protocol to score by (default: erasor)")
      ->type_name("NAME")
      ->allow_extra_args(false);
  sequence.add_to(app);
  app.add_option("--threads", threads, "At most so many threads (default: all cores)")
      ->type_name("N");
  app.add_option("--time-limit", time_limit,
                 "Seconds a cell may take (default: 30 for each scan, at least 600)")
      ->type_name("SECONDS");
  app.add_option("--memory-limit", memory_limit,
                 "MiB of memory a method may use (default: nine tenths of the machine's)")
      ->type_name("MIB");
}

}  // namespace raymoval
