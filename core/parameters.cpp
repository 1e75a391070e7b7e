// SPDX-License-Identifier: MIT
#include "core/parameters.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/text.h"

namespace raymoval {
namespace {

std::string type_name(const ParameterSpec& spec) {
  if (!spec.choices.empty()) return "one of " + join(spec.choices);
  switch (spec.default_value.index()) {
    case 0:
      return "true or false";
    case 1:
      return "a whole number";
    case 2:
      return "a number";
    default:
      return "a text";
  }
}

std::string range_text(const ParameterNotes& notes) {
  return plain_number_text(notes.minimum) + " to " + plain_number_text(notes.maximum) +
         (notes.unit.empty() ? "" : " " + notes.unit);
}

[[noreturn]] void throw_bad_value(const std::string& owner, const ParameterSpec& spec,
                                  const std::string& given) {
  throw ConfigurationError(owner + "." + spec.name + " = " + given + ": expected " +
                           type_name(spec) + ". " + spec.notes.sentence);
}

void check_range(const std::string& owner, const ParameterSpec& spec, double value) {
  if (value >= spec.notes.minimum && value <= spec.notes.maximum && !std::isnan(value)) return;
  throw ConfigurationError(owner + "." + spec.name + " = " + number_text(value) +
                           " is out of range: expected " + range_text(spec.notes) + ". " +
                           spec.notes.sentence);
}

ParameterValue checked_choice(const std::string& owner, const ParameterSpec& spec,
                              const std::string& text) {
  const bool known =
      std::find(spec.choices.begin(), spec.choices.end(), text) != spec.choices.end();
  if (!spec.choices.empty() && !known) {
    throw ConfigurationError(owner + "." + spec.name + " = '" + text + "' is unknown." +
                             suggestion(text, spec.choices));
  }
  return text;
}

}  // namespace

std::string parameter_text(const ParameterValue& value) {
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return std::to_string(*integer);
  if (const double* number = std::get_if<double>(&value)) return number_text(*number);
  return std::get<std::string>(value);
}

ParameterValue checked_value(const std::string& owner, const ParameterSpec& spec,
                             const nlohmann::json& json) {
  switch (spec.default_value.index()) {
    case 0:
      if (json.is_boolean()) return json.get<bool>();
      break;
    case 1:
      if (json.is_number_integer()) {
        const auto value = json.get<std::int64_t>();
        check_range(owner, spec, static_cast<double>(value));
        return value;
      }
      break;
    case 2:
      if (json.is_number()) {
        const auto value = json.get<double>();
        check_range(owner, spec, value);
        return value;
      }
      break;
    default:
      if (json.is_string()) return checked_choice(owner, spec, json.get<std::string>());
  }
  throw_bad_value(owner, spec, json.dump());
}

ParameterValue checked_value_from_text(const std::string& owner, const ParameterSpec& spec,
                                       const std::string& text) {
  switch (spec.default_value.index()) {
    case 0:
      if (text == "true" || text == "false") return text == "true";
      break;
    case 1:
      if (const auto value = parse_number<std::int64_t>(text)) {
        check_range(owner, spec, static_cast<double>(*value));
        return *value;
      }
      break;
    case 2:
      if (const auto value = parse_number<double>(text)) {
        check_range(owner, spec, *value);
        return *value;
      }
      break;
    default:
      return checked_choice(owner, spec, text);
  }
  throw_bad_value(owner, spec, "'" + text + "'");
}

const ParameterSpec& find_parameter(const std::string& owner,
                                    const std::vector<ParameterSpec>& specs,
                                    const std::string& name) {
  std::vector<std::string> names;
  for (const ParameterSpec& spec : specs) {
    if (spec.name == name) return spec;
    names.push_back(spec.name);
  }
  if (names.empty()) throw ConfigurationError(owner + " has no parameters, so no '" + name + "'.");
  throw ConfigurationError(owner + " has no parameter '" + name + "'." + suggestion(name, names));
}

void set_parameter(Configuration& configuration, const std::string& name, ParameterValue value) {
  for (auto& [key, stored] : configuration) {
    if (key == name) {
      stored = std::move(value);
      return;
    }
  }
  throw InternalError("no parameter '" + name + "' in this configuration");
}

nlohmann::ordered_json to_json(const Configuration& configuration) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const auto& [name, value] : configuration) {
    std::visit([&, &key = name](const auto& held) { json[key] = held; }, value);
  }
  return json;
}

}  // namespace raymoval
