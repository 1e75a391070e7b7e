// SPDX-License-Identifier: MIT
#include <memory>

#include "benchmark/cli/command.h"
#include "benchmark/result/checks/result_sets.h"
#include "benchmark/result/run_record_json.h"
#include "benchmark/tables/citations.h"
#include "core/files/file_kind.h"
#include "core/text.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

/// Adds a method, a protocol or a run. @throws UsageError suggesting the nearest name
void add_named(const std::string& name, Citations& citations) {
  if (const MethodEntry* entry = citations.known_method(name)) {
    return citations.add_method(*entry);
  }
  const std::string protocol = without_protocol_prefix(name);
  if (const ProtocolEntry* entry = find_protocol(protocol)) return citations.add(entry->bibtex);
  if (is_there(name)) return citations.add_run(read_results(find_results(name)).run);
  std::vector<std::string> names;
  for (const auto& entry : program_methods().entries()) names.push_back(entry->name);
  for (const ProtocolEntry& entry : protocol_entries()) names.push_back(entry.name);
  throw UsageError("cite " + name + ": there is no such method, protocol or run." +
                   suggestion(protocol, names));
}

ExitCode cite(const std::vector<std::string>& names) {
  Citations citations(program_methods());
  for (const std::string& name : names) add_named(name, citations);
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
