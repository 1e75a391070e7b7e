// SPDX-License-Identifier: MIT
#include "benchmark/cli/description.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>

#include "benchmark/tables/text/text_table.h"
#include "core/parameter_condition.h"
#include "core/text.h"

namespace raymoval {
namespace {

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

/// What a parameter does, and when.
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
  TextTable table{
      "", "name", {{"", {"default", "unit", "range", "source", "what it does"}}}, {}, {}};
  for (std::size_t i = 0; i < description.parameters.size(); ++i) {
    const ParameterSpec& spec = description.parameters[i];
    const ParameterNotes& notes = spec.notes;
    table.rows.push_back({spec.name,
                          {{parameter_text(spec.default_value)},
                           {notes.unit},
                           {range_text(spec)},
                           {notes.source.empty() ? "ours" : notes.source},
                           {sentence_of(description, i)}},
                          false});
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

std::string parameter_lines(const Description& description) {
  std::string text = description.parameters.empty() ? "" : "Parameters:\n";
  for (std::size_t i = 0; i < description.parameters.size(); ++i) {
    const ParameterSpec& spec = description.parameters[i];
    const std::string& unit = spec.notes.unit;
    text += "  " + spec.name + " = " + parameter_text(spec.default_value) +
            (unit.empty() ? "" : " " + unit);
    const std::string range = range_text(spec);
    text += (range.empty() ? "" : "   [" + range + "]") + "   " +
            (spec.notes.source.empty() ? "ours" : spec.notes.source) + "\n";
    const std::string sentence = sentence_of(description, i);
    if (!sentence.empty()) text += "      " + sentence + "\n";
  }
  return text;
}

/// What a method says of how sure it is, as a line; empty for a protocol.
std::string confidence_line(const Description& description) {
  if (!description.confidence) return "";
  return "Confidence: " + (description.confidence->empty() ? "none." : *description.confidence) +
         "\n";
}

}  // namespace

Description describe_method(const MethodRegistry& registry, const std::string& name_and_variant) {
  const ConfiguredMethod method = registry.configure(name_and_variant);
  const MethodEntry& entry = *method.entry;
  Description description{entry.name,  entry.sentence, entry.source,    entry.version,
                          entry.notes, entry.variants, entry.parameters};
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

std::string description_text(const Description& description) {
  std::string text =
      description.name + " (version " + description.version + ")\n" + description.sentence + "\n";
  if (!description.source.empty()) text += "Source: " + description.source + "\n";
  text += confidence_line(description);
  if (!description.variants.empty()) text += "Variants:\n";
  for (const MethodVariant& variant : description.variants) {
    text += "  " + variant.name + (variant.online ? " [online]" : " [offline]") + ": " +
            variant.sentence + overrides_text(variant) + "\n";
  }
  text += parameter_lines(description);
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
    // Most columns are words, which begin on the left, and not numbers.
    const auto line = table.begin() + static_cast<std::ptrdiff_t>(table.find('\n')) + 1;
    std::replace(line, std::find(line, table.end(), '\n'), ':', '-');
    text += "\n" + table;
  }
  if (!description.notes.empty()) text += "\n";
  for (const std::string& note : description.notes) text += "- " + note + "\n";
  return text;
}

}  // namespace raymoval
