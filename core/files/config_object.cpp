// SPDX-License-Identifier: MIT
#include "core/files/config_object.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files/files.h"
#include "core/text.h"

namespace raymoval {

ConfigObject::ConfigObject(const nlohmann::json& json, std::string where,
                           const std::vector<std::string>& keys)
    : json_(json), where_(std::move(where)) {
  check_keys(json, keys, where_);
}

void ConfigObject::fail(const std::string& key, const std::string& expected) const {
  const std::string found = has(key) ? json_.at(key).dump() : "nothing";
  throw ConfigurationError(
      fmt::format("{}: '{}' is {}, expected {}.", where_, key, found.substr(0, 60), expected));
}

bool ConfigObject::has(const std::string& key) const {
  return json_.contains(key);
}

const nlohmann::json& ConfigObject::member(const std::string& key) const {
  if (has(key)) return json_.at(key);
  throw ConfigurationError(fmt::format("{}: key '{}' is missing; it has no default.", where_, key));
}

double ConfigObject::number(const std::string& key, double fallback, double low,
                            double high) const {
  if (!has(key)) return fallback;
  if (!json_.at(key).is_number()) fail(key, "a number");
  const auto number = json_.at(key).get<double>();
  if (!(number >= low && number <= high)) {
    fail(key, fmt::format("a number from {} to {}", number_text(low), number_text(high)));
  }
  return number;
}

double ConfigObject::positive(const std::string& key, double fallback) const {
  if (!has(key)) return fallback;
  const double value = json_.at(key).is_number() ? json_.at(key).get<double>() : 0.0;
  if (!(value > 0.0) || !std::isfinite(value)) fail(key, "a number greater than 0");
  return value;
}

int ConfigObject::integer(const std::string& key, int fallback, int low, int high) const {
  if (!has(key)) return fallback;
  const double value = number(key, fallback, low, high);
  if (value != std::floor(value)) fail(key, "a whole number");
  return static_cast<int>(value);
}

bool ConfigObject::flag(const std::string& key, bool fallback) const {
  if (!has(key)) return fallback;
  if (!json_.at(key).is_boolean()) fail(key, "true or false");
  return json_.at(key).get<bool>();
}

std::string ConfigObject::text(const std::string& key, const std::string& fallback) const {
  if (!has(key)) return fallback;
  if (!json_.at(key).is_string()) fail(key, "a text in quotes");
  return json_.at(key).get<std::string>();
}

std::string ConfigObject::text(const std::string& key) const {
  static_cast<void>(member(key));
  std::string value = text(key, "");
  if (value.empty()) fail(key, "a text that is not empty");
  return value;
}

std::vector<std::string> ConfigObject::texts(const std::string& key) const {
  std::vector<std::string> texts;
  for (const auto& [item, item_place] : list(key)) {
    if (!item->is_string()) fail(key, "a list of texts [ \"...\", ... ]");
    texts.push_back(item->get<std::string>());
  }
  return texts;
}

std::vector<std::pair<const nlohmann::json*, std::string>> ConfigObject::list(
    const std::string& key) const {
  std::vector<std::pair<const nlohmann::json*, std::string>> values;
  if (!has(key)) return values;
  const nlohmann::json& items = json_.at(key);
  if (!items.is_array()) fail(key, "a list of values [ ... ]");
  for (std::size_t i = 0; i < items.size(); ++i) {
    values.emplace_back(&items[i], fmt::format("{}[{}]", place(key), i));
  }
  return values;
}

}  // namespace raymoval
