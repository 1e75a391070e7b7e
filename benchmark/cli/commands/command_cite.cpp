// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "benchmark/cli/command.h"
#include "benchmark/process/machine.h"
#include "benchmark/result/checks/result_sets.h"
#include "benchmark/result/run_record_json.h"
#include "core/files/file_kind.h"
#include "core/text.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

/// What is cited, each entry once, in the order in which it is asked for.
class Citations {
 public:
  Citations() {
    add(fmt::format(
        "@software{{raymoval,\n  author = {{{{The raymoval authors}}}},\n"
        "  title = {{raymoval: evaluation and benchmarking of dynamic-object removal in "
        "static LiDAR mapping}},\n  version = {{{}}}\n}}\n",
        build_record().version));
  }

  /// A method, a protocol or a run. @throws UsageError suggesting the nearest name
  void add_named(const std::string& name) {
    if (const MethodEntry* entry = known_method(name)) return add_method(*entry);
    const std::string protocol = without_protocol_prefix(name);
    if (const ProtocolEntry* entry = find_protocol(protocol)) return add_protocol(*entry);
    if (is_there(name)) return add_run(name);
    std::vector<std::string> names;
    for (const auto& entry : program_methods().entries()) names.push_back(entry->name);
    for (const ProtocolEntry& entry : protocol_entries()) names.push_back(entry.name);
    throw UsageError("cite " + name + ": there is no such method, protocol or run." +
                     suggestion(protocol, names));
  }

  [[nodiscard]] std::string text() const { return join(entries_, "\n"); }

 private:
  void add(const std::string& entry) {
    if (std::find(entries_.begin(), entries_.end(), entry) == entries_.end()) {
      entries_.push_back(entry);
    }
  }

  void add_method(const MethodEntry& entry) {
    const bool is_ours = entry.source == "this project" || is_control(entry.name);
    if (!entry.bibtex.empty()) {
      add(entry.bibtex);
    } else if (!is_ours) {
      add("% " + entry.name + ": " + entry.source + "\n");
    }
  }

  void add_protocol(const ProtocolEntry& entry) {
    if (!entry.bibtex.empty()) add(entry.bibtex);
  }

  void add_run(const std::string& run) {
    const RunRecord record = read_results(find_results(run)).run;
    for (const auto& method : record.methods) {
      if (const MethodEntry* entry = known_method(method.method)) {
        add_method(*entry);
      } else {
        add("% " + method.method + ": this program does not know the method\n");
      }
    }
    for (const auto& protocol : record.protocols) {
      if (const ProtocolEntry* entry = find_protocol(protocol.protocol)) add_protocol(*entry);
    }
  }

  /// @param full_name with or without a variant
  static const MethodEntry* known_method(const std::string& full_name) {
    const std::string name = full_name.substr(0, full_name.find(':'));
    for (const auto& entry : program_methods().entries()) {
      if (entry->name == name) return entry.get();
    }
    return nullptr;
  }

  std::vector<std::string> entries_;
};

ExitCode cite(const std::vector<std::string>& names) {
  Citations citations;
  for (const std::string& name : names) citations.add_named(name);
  print(citations.text());
  return ExitCode::kDone;
}

}  // namespace

Command add_cite_command(CommandParser& program) {
  auto names = std::make_shared<std::vector<std::string>>();
  CommandOptions options =
      program.add_command("cite", "Prints BibTeX of methods, protocols, or all that a run used");
  options.add("name", "NAME", *names, "METHOD, PROTOCOL, protocol:NAME, or a run folder; several");
  options.set_footer(
      "This program is cited first. A method that is ours, or that has no publication, adds "
      "nothing.\n"
      "Examples:\n  raymoval cite octomap erasor protocol:dynamicmap\n  raymoval cite out/05 "
      "> references.bib");
  return {options.name(), [names] { return cite(*names); }};
}

}  // namespace raymoval
