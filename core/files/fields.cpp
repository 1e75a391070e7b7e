// SPDX-License-Identifier: MIT
#include "core/files/fields.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files/files.h"
#include "core/text.h"

namespace raymoval {

Fields::Fields(const nlohmann::json& json, std::string where, std::string_view keys)
    : json_(json), where_(std::move(where)) {
  std::vector<std::string> known;
  for (const std::string_view key : split_blanks(keys)) known.emplace_back(key);
  check_keys(json, known, where_);
}

void Fields::fail(const std::string& key, const std::string& expected) const {
  const std::string found = json_.contains(key) ? json_.at(key).dump() : "nothing";
  throw ConfigurationError(where_ + ": '" + key + "' is " + found.substr(0, 60) + ", expected " +
                           expected + ".");
}

bool Fields::has(const std::string& key) const {
  return json_.contains(key);
}

const nlohmann::json& Fields::member(const std::string& key) const {
  if (!has(key)) {
    throw ConfigurationError(where_ + ": key '" + key + "' is missing; it has no default.");
  }
  return json_.at(key);
}

bool Fields::is_number(const std::string& key) const {
  return has(key) && json_.at(key).is_number();
}

std::vector<std::string> Fields::names() const {
  std::vector<std::string> names;
  for (const auto& [name, value] : json_.items()) names.push_back(name);
  return names;
}

double Fields::number(const std::string& key, double fallback, double low, double high) const {
  if (!has(key)) return fallback;
  const nlohmann::json& value = json_.at(key);
  if (!value.is_number()) fail(key, "a number");
  const auto number = value.get<double>();
  if (!(number >= low && number <= high)) {
    fail(key, "a number from " + number_text(low) + " to " + number_text(high));
  }
  return number;
}

double Fields::positive(const std::string& key, double fallback) const {
  if (!has(key)) return fallback;
  const double value = is_number(key) ? json_.at(key).get<double>() : 0.0;
  if (!(value > 0.0) || !std::isfinite(value)) fail(key, "a number greater than 0");
  return value;
}

int Fields::integer(const std::string& key, int fallback, int low, int high) const {
  const double value = number(key, fallback, low, high);
  if (value != std::floor(value)) fail(key, "a whole number");
  return static_cast<int>(value);
}

bool Fields::flag(const std::string& key, bool fallback) const {
  if (!has(key)) return fallback;
  if (!json_.at(key).is_boolean()) fail(key, "true or false");
  return json_.at(key).get<bool>();
}

std::string Fields::text(const std::string& key, const std::string& fallback) const {
  if (!has(key)) return fallback;
  if (!json_.at(key).is_string()) fail(key, "text in quotes");
  return json_.at(key).get<std::string>();
}

std::string Fields::text(const std::string& key) const {
  static_cast<void>(member(key));
  std::string value = text(key, "");
  if (value.empty()) fail(key, "a text that is not empty");
  return value;
}

std::vector<std::string> Fields::texts(const std::string& key) const {
  std::vector<std::string> texts;
  for (const auto& [item, item_place] : list(key)) {
    if (!item->is_string()) fail(key, "a list of texts [ \"...\", ... ]");
    texts.push_back(item->get<std::string>());
  }
  return texts;
}

std::string Fields::choice(const std::string& key, const std::string& fallback,
                           const std::vector<std::string>& choices) const {
  std::string value = text(key, fallback);
  if (std::find(choices.begin(), choices.end(), value) == choices.end()) {
    throw ConfigurationError(where_ + ": '" + key + "' has the unknown value '" + value + "'." +
                             suggestion(value, choices));
  }
  return value;
}

NumberRange Fields::interval(const std::string& key, NumberRange fallback, double lowest,
                             double highest) const {
  if (!has(key)) return fallback;
  if (is_number(key)) {
    const double value = number(key, 0.0, lowest, highest);
    return {value, value};
  }
  const std::vector<double> values = numbers(key);
  if (values.size() != 2 || values[0] > values[1]) fail(key, "a number or [low, high]");
  if (values[0] < lowest || values[1] > highest) {
    fail(key, "numbers from " + number_text(lowest) + " to " + number_text(highest));
  }
  return {values[0], values[1]};
}

std::vector<double> Fields::numbers(const std::string& key) const {
  std::vector<double> values;
  if (!has(key)) return values;
  const nlohmann::json& json = json_.at(key);
  if (!json.is_array()) fail(key, "a list of numbers");
  for (const auto& value : json) {
    if (!value.is_number()) fail(key, "a list of numbers");
    values.push_back(value.get<double>());
  }
  return values;
}

std::vector<std::pair<double, double>> Fields::pairs(const std::string& key) const {
  std::vector<std::pair<double, double>> values;
  if (!has(key)) return values;
  const std::string form = "a list of pairs [[a, b], ...]";
  if (!json_.at(key).is_array()) fail(key, form);
  for (const auto& value : json_.at(key)) {
    const bool pair =
        value.is_array() && value.size() == 2 && value[0].is_number() && value[1].is_number();
    if (!pair) fail(key, form);
    values.emplace_back(value[0].get<double>(), value[1].get<double>());
  }
  return values;
}

std::vector<Eigen::Vector2d> Fields::points(const std::string& key, double reach) const {
  std::vector<Eigen::Vector2d> values;
  for (const auto& [x, y] : pairs(key)) {
    if (std::abs(x) > reach || std::abs(y) > reach) {
      fail(key, "points at most " + number_text(reach) + " m from the origin");
    }
    values.emplace_back(x, y);
  }
  return values;
}

std::vector<std::pair<const nlohmann::json*, std::string>> Fields::list(
    const std::string& key) const {
  std::vector<std::pair<const nlohmann::json*, std::string>> values;
  if (!has(key)) return values;
  const nlohmann::json& json = json_.at(key);
  if (!json.is_array()) fail(key, "a list of values [ ... ]");
  for (std::size_t i = 0; i < json.size(); ++i) {
    values.emplace_back(&json[i], place(key) + "[" + std::to_string(i) + "]");
  }
  return values;
}

}  // namespace raymoval
