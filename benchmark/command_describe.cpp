// SPDX-License-Identifier: MIT
#include <memory>
#include <nlohmann/json.hpp>

#include "benchmark/commands.h"
#include "benchmark/description.h"
#include "benchmark/sealed_json.h"
#include "core/text.h"

namespace raymoval {
namespace {

struct DescribeFlags {
  std::string name;
  bool markdown = false;
  bool json = false;
};

Description description_of(const std::string& name) {
  const MethodRegistry& registry = program_methods();
  std::vector<std::string> names;
  for (const ProtocolEntry& entry : protocol_entries()) {
    if (entry.name == name) return describe_protocol(entry);
    names.push_back(entry.name);
  }
  const std::string method = name.substr(0, name.find(':'));
  for (const auto& entry : registry.entries()) {
    if (entry->name == method) return describe_method(registry, name);
    names.push_back(entry->name);
  }
  throw UsageError("there is no method or protocol '" + name + "'." + suggestion(name, names));
}

ExitCode describe(const DescribeFlags& flags) {
  if (flags.name.empty()) {
    throw UsageError("describe what? Name a method or a protocol (see `raymoval list`).");
  }
  if (flags.markdown && flags.json) throw UsageError("choose one of --markdown and --json.");
  const Description description = description_of(flags.name);
  if (flags.json) {
    print(json_text(to_json(description)));
  } else {
    print(flags.markdown ? description_markdown(description) : description_text(description));
  }
  return ExitCode::kDone;
}

}  // namespace

Command add_describe_command(CLI::App& program) {
  auto flags = std::make_shared<DescribeFlags>();
  CLI::App* app =
      program.add_subcommand("describe", "Tells a method's or protocol's source and parameters");
  app->allow_extras();
  app->add_option("name", flags->name, "METHOD, METHOD:variant or PROTOCOL")->type_name("NAME");
  app->add_flag("--markdown", flags->markdown, "As Markdown");
  app->add_flag("--json", flags->json, "As JSON");
  app->footer("Examples:\n  raymoval describe raymoval:online\n  raymoval describe erasor --json");
  return {app, [flags] { return describe(*flags); }};
}

}  // namespace raymoval
