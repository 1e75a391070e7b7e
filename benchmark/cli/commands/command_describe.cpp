// SPDX-License-Identifier: MIT
#include <algorithm>
#include <memory>

#include "benchmark/cli/command.h"
#include "benchmark/cli/commands/output_json.h"
#include "core/text.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

struct DescribeFlags {
  std::string name;
  bool markdown = false;
  bool json = false;
};

constexpr const char* kProtocolPrefix = "protocol:";

/// A name that is both a method's and a protocol's means the method.
Description description_of(const std::string& name) {
  const MethodRegistry& registry = program_methods();
  std::vector<std::string> names;
  const std::string method = name.substr(0, name.find(':'));
  for (const auto& entry : registry.entries()) {
    if (entry->name == method) return describe_method(registry, name);
    names.push_back(entry->name);
  }
  if (method == "external") return describe_method(registry, name);
  const bool prefixed = name.rfind(kProtocolPrefix, 0) == 0;
  const std::string protocol = prefixed ? name.substr(std::string(kProtocolPrefix).size()) : name;
  if (const ProtocolEntry* entry = find_protocol(protocol)) return describe_protocol(*entry);
  for (const ProtocolEntry& entry : protocol_entries()) names.push_back(entry.name);
  const std::string owner = protocol.substr(0, protocol.rfind('.'));
  if (owner != protocol && std::find(names.begin(), names.end(), owner) != names.end()) {
    throw UsageError("'" + protocol + "' is a parameter; `raymoval describe " + owner +
                     "` lists those of " + owner + " with their meaning.");
  }
  throw UsageError("there is no method or protocol '" + protocol + "'." +
                   suggestion(protocol, names));
}

bool is_also_protocol(const std::string& name) {
  for (const auto& entry : program_methods().entries()) {
    if (entry->name == name) return find_protocol(name) != nullptr;
  }
  return false;
}

ExitCode describe(const DescribeFlags& flags) {
  if (flags.name.empty()) {
    throw UsageError("describe what? Name a method or a protocol (see `raymoval list`).");
  }
  if (flags.markdown && flags.json) throw UsageError("choose one of --markdown and --json.");
  const Description description = description_of(flags.name);
  if (flags.json) {
    print(output_json(description));
  } else {
    print(flags.markdown ? description_markdown(description) : description_text(description));
    if (is_also_protocol(flags.name)) {
      print("\nThe protocol of this name: raymoval describe " + (kProtocolPrefix + flags.name) +
            "\n");
    }
  }
  return ExitCode::kDone;
}

}  // namespace

Command add_describe_command(CommandParser& program) {
  auto flags = std::make_shared<DescribeFlags>();
  CommandOptions options = program.add_command(
      "describe", "Shows the source and the parameters of a method or protocol");
  options.add("name", "NAME", flags->name,
              "METHOD, METHOD:variant, external:MANIFEST, PROTOCOL or protocol:NAME");
  options.add_flag("--markdown", flags->markdown, "Print Markdown");
  options.add_flag("--json", flags->json, "Print JSON");
  options.set_footer(
      "Examples:\n  raymoval describe raymoval:online\n  raymoval describe protocol:erasor --json");
  return {options.name(), [flags] { return describe(*flags); }};
}

}  // namespace raymoval
