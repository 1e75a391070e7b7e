// SPDX-License-Identifier: MIT
#include "benchmark/cli/suite_flags.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "benchmark/suite/amounts.h"
#include "benchmark/suite/shipped_suites.h"
#include "core/error.h"
#include "core/terminal_colour.h"
#include "datasets/clouds/frames.h"
#include "datasets/open_sequence.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

/// Whether the word without an option is a sequence and not a suite. The name of a shipped suite or
/// of a file always means the suite. A name that does not exist means a sequence if the other
/// options name methods or sequences.
bool means_sequence(const SuiteFlags& flags) {
  const std::string& path = flags.suite;
  const auto shipped = shipped_suite_names();
  const bool is_suite = std::find(shipped.begin(), shipped.end(), path) != shipped.end();
  if (path.empty() || is_suite || is_file(path)) return false;
  const bool is_sequence =
      is_folder(path) || is_scene(path) || is_folder(path.substr(0, path.rfind(':')));
  return is_sequence || !flags.methods.empty() || !flags.sequences.empty();
}

/// A hint for naming a folder or scene that has the name of a suite; empty if there is none.
std::string folder_hint(const std::string& suite) {
  if (!is_folder(suite) || suite.find('/') != std::string::npos) return "";
  return " If the folder of that name is meant, write ./" + suite + ".";
}

/// Refuses options that the suite file already sets.
void check_suite_alone(const SuiteFlags& flags) {
  std::string given = flags.sequence.first_given();
  if (!flags.protocols.empty()) given = "--protocol";
  if (!flags.as.empty()) given = "--as";
  if (!flags.methods.empty()) given = "--method";
  if (!flags.sequences.empty()) given = "--sequence";
  if (given.empty()) return;
  throw UsageError(given + " cannot be given together with the suite " + flags.suite +
                   "; write it into a suite file, or leave the suite out." +
                   folder_hint(flags.suite));
}

/// Adds the methods of the command line. A method that is named and also part of "all" is added
/// once.
void add_methods(const SuiteFlags& flags, const MethodRegistry& registry, Suite& suite) {
  if (!flags.as.empty()) {
    const std::string& method = flags.methods.front();
    if (flags.methods.size() > 1 || expanded_methods(method, registry) != std::vector{method}) {
      throw UsageError("--as " + flags.as +
                       ": names one method, but there are several. Run them one after the other "
                       "with the same --out, or use a suite file.");
    }
    add_method(suite, method, flags.as, registry);
    return;
  }
  std::vector<std::string> named;
  for (const std::string& method : flags.methods) {
    if (expanded_methods(method, registry) == std::vector{method}) {
      named.push_back(registry.configure(method).full_name());
    }
  }
  for (const std::string& method : flags.methods) {
    const std::vector<std::string> names = expanded_methods(method, registry);
    const bool one = names == std::vector{method};
    for (const std::string& name : names) {
      const bool also_named = std::find(named.begin(), named.end(), name) != named.end();
      if (one || !also_named) add_method(suite, name, "", registry);
      if (!one) named.push_back(name);
    }
  }
}

Suite suite_from_flags(const SuiteFlags& flags, const MethodRegistry& registry) {
  if (flags.sequences.empty()) {
    throw UsageError("nothing to run on: name a suite, or a sequence with --sequence PATH.");
  }
  if (flags.methods.empty()) {
    throw UsageError(
        "nothing to run: name a method with --method NAME[:variant], or all of them with "
        "--method all (see `raymoval list methods`).");
  }
  if (flags.sequences.size() > 1 && !flags.sequence.text("name").empty()) {
    throw UsageError(fmt::format("--name names one sequence, but there are {}; use a suite file.",
                                 flags.sequences.size()));
  }
  Suite suite;
  const SequenceOptions options = flags.sequence.options();
  for (const std::string& path : flags.sequences) {
    check_not_both(path);
    suite.sequences.push_back({path, options});
  }
  add_methods(flags, registry, suite);
  for (const std::string& protocol : flags.protocols) add_protocol(suite, protocol, "");
  return suite;
}

}  // namespace

Suite SuiteFlags::resolved() const {
  SuiteFlags flags = *this;
  const MethodRegistry& registry = program_methods();
  std::vector<Setting> parsed;  // First: "--set KEY VALUE" leaves VALUE to be taken for a suite.
  for (const std::string& text : flags.settings) parsed.push_back(parse_setting(text));
  if (means_sequence(flags)) {
    flags.sequences.insert(flags.sequences.begin(), flags.suite);
    flags.suite.clear();
  }
  if (!flags.suite.empty()) check_suite_alone(flags);
  if (flags.suite.empty() && !data.empty()) {
    throw UsageError("--data needs a suite file that names {data}; use --sequence.");
  }
  Suite made = flags.suite.empty() ? suite_from_flags(flags, registry)
                                   : read_suite(find_suite(flags.suite), registry, data);
  if (made.protocols.empty()) add_protocol(made, default_protocol(), "");
  apply_settings(made, parsed);
  if (made.controls) add_controls(made, registry);
  if (const int count = parse_threads(flags.threads); count > 0) made.threads = count;
  if (!time_limit.empty()) made.time_limit_s = parse_seconds("--time-limit", time_limit);
  if (!memory_limit.empty()) {
    made.memory_limit_mib = parse_memory_mib("--memory-limit", memory_limit);
  }
  return made;
}

void warn_of_settings_without_effect(const Suite& suite) {
  for (const std::string& line : settings_without_effect(suite)) {
    print_warning(line);
  }
}

void SuiteFlags::add_to(CommandOptions& options) {
  options.group("Sequence options");
  options.add("suite", "SUITE", suite,
              "Suite file (JSON, comments allowed), name of a shipped suite, or a sequence as "
              "for --sequence");
  options.add("--data", "ROOT", data, "Root of the data set that the suite calls {data}");
  options.add("--sequence", "PATH", sequences, "Sequence folder, ROOT:05, `street`, or a scene");
  sequence.add_to(options);
  options.group("Method options");
  options.add("--method", "NAME", methods,
              "Method to run, NAME or NAME:variant; NAME:all for all its variants, all for each "
              "method's default");
  options.add("--set", "SETTING", settings,
              "Parameter: METHOD.key=value or METHOD:variant.key=...; option of a protocol: "
              "protocol:NAME.key=...");
  options.add(
      "--as", "NAME", as,
      "Name of the method in the results (default: METHOD:variant, with a * if --set changes "
      "a parameter)");
  options.add("--protocol", "NAME", protocols, "Protocol to score by (default: erasor)");
  options.group("Limit options");
  options.add("--threads", "N", threads, "Use at most N threads (default: all cores)");
  options.add("--time-limit", "TIME", time_limit,
              "Time a cell may take, in seconds or as 5min, 2h (default: 30 s for each scan, at "
              "least 600 s)");
  options.add("--memory-limit", "SIZE", memory_limit,
              "Memory a method may use, in MiB or as 500MB, 2GB, 2GiB (default: nine tenths of "
              "the machine's)");
}

}  // namespace raymoval
