// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "benchmark/cli/command.h"
#include "benchmark/cli/description.h"
#include "benchmark/tables/text/text_table.h"
#include "core/parameter_condition.h"
#include "core/text.h"
#include "eval/protocol.h"
#include "eval/protocol_registry.h"

namespace raymoval {

namespace {

/// The content of `raymoval describe`, independent of its format.
struct Description {
  std::string name;
  std::string sentence;
  std::string source;
  std::string version;
  std::vector<std::string> notes;
  std::vector<MethodVariant> variants;
  std::vector<ParameterSpec> parameters;  ///< Defaults are those of the variant described.
  /// Whether each parameter has an effect while the others have their defaults; all true if no
  /// single variant is described.
  std::vector<bool> acts = {};
  /// What a method's confidence is made of; empty if it has none. No value for a protocol.
  std::optional<std::string> confidence = std::nullopt;
  std::vector<std::string> main_parameters = {};  ///< Empty: all.
  std::string advice = {};
};

/// The source of a default; "own choice" if the parameter has none.
std::string source_text(const ParameterSpec& spec) {
  return spec.notes.source.empty() ? "chosen here" : spec.notes.source;
}

std::string range_text(const ParameterSpec& spec) {
  if (!spec.choices.empty()) return join(spec.choices, ", ");
  if (std::holds_alternative<bool>(spec.default_value)) return "true, false";
  const bool low = std::isfinite(spec.notes.minimum);
  const bool high = std::isfinite(spec.notes.maximum);
  if (low && high) {
    return plain_number_text(spec.notes.minimum) + " to " + plain_number_text(spec.notes.maximum);
  }
  if (low) return "from " + plain_number_text(spec.notes.minimum);
  return high ? "to " + plain_number_text(spec.notes.maximum) : "";
}

/// The effect of a parameter, and its condition.
std::string sentence_of(const Description& description, std::size_t i) {
  const ParameterSpec& spec = description.parameters[i];
  if (spec.notes.acts_when.empty()) return spec.notes.sentence;
  std::string when = effect_text(spec);
  if (!description.acts.empty() && !description.acts[i])
    when = "NO EFFECT in this variant: " + when;
  when.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(when.front())));
  return spec.notes.sentence + (spec.notes.sentence.empty() ? "" : " ") + when + ".";
}

TextTable parameter_table(const Description& description) {
  TextTable table{"", "name", {{"", {"default", "unit", "range", "source", "what it does"}}}};
  for (std::size_t i = 0; i < description.parameters.size(); ++i) {
    const ParameterSpec& spec = description.parameters[i];
    const ParameterNotes& notes = spec.notes;
    table.rows.push_back({spec.name,
                          {{parameter_text(spec.default_value)},
                           {notes.unit},
                           {range_text(spec)},
                           {source_text(spec)},
                           {sentence_of(description, i)}}});
  }
  return table;
}

std::string overrides_text(const MethodVariant& variant) {
  std::vector<std::string> parts;
  for (const auto& [name, value] : variant.overrides) {
    parts.push_back(name + " = " + parameter_text(value));
  }
  return parts.empty() ? "" : " (" + join(parts) + ")";
}

/// Indices of the shown parameters: the main ones first, then the others if `all`.
std::vector<std::size_t> shown_parameters(const Description& description, bool all) {
  const std::vector<std::string>& first = description.main_parameters;
  std::vector<std::size_t> shown;
  for (const std::string& name : first) {
    const auto found = std::find_if(description.parameters.begin(), description.parameters.end(),
                                    [&](const ParameterSpec& spec) { return spec.name == name; });
    shown.push_back(static_cast<std::size_t>(found - description.parameters.begin()));
  }
  for (std::size_t i = 0; (all || first.empty()) && i < description.parameters.size(); ++i) {
    const std::string& name = description.parameters[i].name;
    if (std::find(first.begin(), first.end(), name) == first.end()) shown.push_back(i);
  }
  return shown;
}

std::string parameter_lines(const Description& description, bool all) {
  const std::vector<std::size_t> shown = shown_parameters(description, all);
  const std::size_t count = description.parameters.size();
  std::string text = description.advice.empty() ? "" : description.advice + "\n";
  if (shown.size() < count) {
    text += "Main parameters (" + std::to_string(shown.size()) + " of " + std::to_string(count) +
            "; --all shows all):\n";
  } else if (count > 0) {
    text += "Parameters:\n";
  }
  for (const std::size_t i : shown) {
    const ParameterSpec& spec = description.parameters[i];
    const std::string& unit = spec.notes.unit;
    text += "  " + spec.name + " = " + parameter_text(spec.default_value) +
            (unit.empty() ? "" : " " + unit);
    const std::string range = range_text(spec);
    text += (range.empty() ? "" : "   [" + range + "]") + "   " + source_text(spec) + "\n";
    const std::string sentence = sentence_of(description, i);
    if (!sentence.empty()) text += "      " + sentence + "\n";
  }
  return text;
}

/// The line on a method's confidence; empty for a protocol.
std::string confidence_line(const Description& description) {
  if (!description.confidence) return "";
  return "Confidence: " + (description.confidence->empty() ? "none." : *description.confidence) +
         "\n";
}

/// Describes a method; with a variant ("raymoval:online") the defaults are the variant's values.
Description describe_method(const MethodRegistry& registry, const std::string& name_and_variant) {
  const ConfiguredMethod method = registry.configure(name_and_variant);
  const MethodEntry& entry = *method.entry;
  Description description{entry.name,  entry.sentence, entry.source,    entry.version,
                          entry.notes, entry.variants, entry.parameters};
  description.main_parameters = entry.main_parameters;
  description.advice = entry.advice;
  description.confidence = entry.confidence.empty() ? "" : entry.confidence.sentence;
  if (name_and_variant.find(':') == std::string::npos) return description;
  description.name = method.full_name();
  description.sentence += " " + method.variant.sentence;
  description.variants = {method.variant};
  for (std::size_t i = 0; i < description.parameters.size(); ++i) {
    description.parameters[i].default_value = method.configuration[i].second;
    description.acts.push_back(has_effect(description.parameters[i], method.configuration));
  }
  return description;
}

Description describe_protocol(const ProtocolEntry& entry) {
  Description description;
  description.name = entry.name;
  description.sentence = entry.sentence;
  description.parameters = entry.parameters;
  description.version = entry.version;
  return description;
}

std::string description_text(const Description& description, bool all) {
  std::string text =
      description.name + " (version " + description.version + ")\n" + description.sentence + "\n";
  if (!description.source.empty()) text += "Source: " + description.source + "\n";
  text += confidence_line(description);
  if (!description.variants.empty()) text += "Variants:\n";
  for (const MethodVariant& variant : description.variants) {
    text += "  " + variant.name + (variant.online ? " [online]" : " [offline]") + ": " +
            variant.sentence + overrides_text(variant) + "\n";
  }
  text += parameter_lines(description, all);
  if (!description.notes.empty()) text += "Notes:\n";
  for (const std::string& note : description.notes) text += "  - " + note + "\n";
  return text;
}

std::string description_markdown(const Description& description) {
  std::string text = "### " + description.name + "\n\n" + description.sentence + "\n";
  if (!description.source.empty()) text += "\nSource: " + description.source + "\n";
  if (description.confidence) text += "\n" + confidence_line(description);
  if (!description.variants.empty()) text += "\n";
  for (const MethodVariant& variant : description.variants) {
    text += "- `" + description.name.substr(0, description.name.find(':')) + ":" + variant.name +
            "` (" + (variant.online ? "online" : "offline") + "): " + variant.sentence +
            overrides_text(variant) + "\n";
  }
  if (!description.parameters.empty()) {
    std::string table = to_markdown(parameter_table(description));
    table.erase(0, table.find('|'));
    // Most columns are words, which are aligned to the left.
    const auto line = table.begin() + static_cast<std::ptrdiff_t>(table.find('\n')) + 1;
    std::replace(line, std::find(line, table.end(), '\n'), ':', '-');
    text += "\n" + table;
  }
  if (!description.notes.empty()) text += "\n";
  for (const std::string& note : description.notes) text += "- " + note + "\n";
  return text;
}

struct DescribeFlags {
  std::string name;
  bool markdown = false;
  bool all = false;
};

/// A name that is both a method's and a protocol's means the method.
Description description_of(const MethodRegistry& registry, const std::string& name) {
  std::vector<std::string> names;
  const std::string method = name.substr(0, name.find(':'));
  for (const auto& entry : registry.entries()) {
    if (entry->name == method) return describe_method(registry, name);
    names.push_back(entry->name);
  }
  if (method == "external") return describe_method(registry, name);
  const std::string protocol = without_protocol_prefix(name);
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
    throw UsageError("NAME is missing: name a method or a protocol (see `raymoval list`).");
  }
  const Description description = description_of(program_methods(), flags.name);
  print(flags.markdown ? description_markdown(description)
                       : description_text(description, flags.all));
  if (is_also_protocol(flags.name)) {
    print("\nThe protocol of this name: raymoval describe " + std::string(kProtocolPrefix) +
          flags.name + "\n");
  }
  return ExitCode::kDone;
}

}  // namespace

std::string described(const MethodRegistry& methods, const std::string& name) {
  return description_text(description_of(methods, name), true);
}

Command add_describe_command(CommandParser& program) {
  auto flags = std::make_shared<DescribeFlags>();
  CommandOptions options = program.add_command(
      "describe", "Shows the source and the parameters of a method or protocol");
  options.add("name", "NAME", flags->name,
              "METHOD, METHOD:variant, external:MANIFEST, PROTOCOL or protocol:NAME");
  options.add_flag("--all", flags->all, "Show all parameters, not only the main ones");
  options.add_flag("--markdown", flags->markdown, "Print Markdown, with all parameters");
  options.set_footer(
      "Examples:\n  raymoval describe raymoval:online\n  raymoval describe raymoval_plus --all\n  "
      "raymoval describe protocol:erasor --markdown");
  return {options.name(), [flags] { return describe(*flags); }};
}

}  // namespace raymoval
