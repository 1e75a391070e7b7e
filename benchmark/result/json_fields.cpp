// SPDX-License-Identifier: MIT
#include "benchmark/result/json_fields.h"

#include <fmt/format.h>

#include <cstdint>
#include <limits>

#include "benchmark/result/cell.h"
#include "core/parameters.h"

namespace raymoval {

using nlohmann::ordered_json;

JsonFields::JsonFields(const ordered_json& json, const std::string& file, std::string place)
    : json_(&json), file_(&file), place_(std::move(place)) {
  expect(json.is_object(), "an object", json, place_);
}

bool JsonFields::has(const char* key) const {
  const auto found = json_->find(key);
  return found != json_->end() && !found->is_null();
}

const ordered_json& JsonFields::at(const char* key) const {
  const auto found = json_->find(key);
  if (found == json_->end()) fail(key, "is missing");
  return *found;
}

const ordered_json& JsonFields::list_at(const char* key) const {
  const ordered_json& items = at(key);
  expect(items.is_array(), "a list", items, place_of(key));
  return items;
}

std::string JsonFields::place_of(const std::string& key) const {
  return place_.empty() ? key : place_ + "." + key;
}

void JsonFields::fail(const std::string& key, const std::string& problem) const {
  fail_at(place_of(key), problem);
}

void JsonFields::check_schema_version() const {
  const auto version = get<std::int64_t>("schema_version");
  if (version == kSchemaVersion) return;
  throw SchemaVersionError(
      fmt::format("{}: schema version {}, expected {}. Run `raymoval run` again with this version.",
                  *file_, version, kSchemaVersion));
}

void JsonFields::fail_at(const std::string& place, const std::string& problem) const {
  throw FieldError(
      fmt::format("{}: not the results of a run ({}{}). Run `raymoval run` again with "
                  "the same --out.",
                  *file_, place.empty() ? "" : place + ": ", problem));
}

void JsonFields::expect(bool good, const char* what, const ordered_json& json,
                        const std::string& place) const {
  if (good) return;
  constexpr std::size_t kMost = 40;
  std::string found = json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  if (found.size() > kMost) found = std::string("a long ") + json.type_name();
  fail_at(place, fmt::format("expected {}, found {}", what, found));
}

template <>
bool JsonFields::read(const ordered_json& json, const std::string& place) const {
  expect(json.is_boolean(), "true or false", json, place);
  return json.get<bool>();
}

template <>
std::uint64_t JsonFields::read(const ordered_json& json, const std::string& place) const {
  const bool whole = json.is_number_integer();
  const bool good = whole && (json.is_number_unsigned() || json.get<std::int64_t>() >= 0);
  expect(good, "a whole number of at least 0", json, place);
  return json.get<std::uint64_t>();
}

template <>
std::int64_t JsonFields::read(const ordered_json& json, const std::string& place) const {
  constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  const bool fits = !json.is_number_unsigned() || json.get<std::uint64_t>() <= kMost;
  expect(json.is_number_integer() && fits, "a whole number", json, place);
  return json.get<std::int64_t>();
}

template <>
int JsonFields::read(const ordered_json& json, const std::string& place) const {
  const auto value = read<std::int64_t>(json, place);
  expect(value >= std::numeric_limits<int>::min() && value <= std::numeric_limits<int>::max(),
         "a whole number of 32 bits", json, place);
  return static_cast<int>(value);
}

template <>
double JsonFields::read(const ordered_json& json, const std::string& place) const {
  expect(json.is_number(), "a number", json, place);
  return json.get<double>();
}

template <>
std::string JsonFields::read(const ordered_json& json, const std::string& place) const {
  expect(json.is_string(), "a text", json, place);
  return json.get<std::string>();
}

template <>
JsonFields JsonFields::read(const ordered_json& json, const std::string& place) const {
  return {json, *file_, place};
}

template <>
std::optional<double> JsonFields::read(const ordered_json& json, const std::string& place) const {
  if (json.is_null()) return std::nullopt;
  return read<double>(json, place);
}

template <>
std::optional<std::pair<double, double>> JsonFields::read(const ordered_json& json,
                                                          const std::string& place) const {
  if (json.is_null()) return std::nullopt;
  expect(json.is_array() && json.size() == 2, "two numbers", json, place);
  return std::pair(read<double>(json[0], place + "[0]"), read<double>(json[1], place + "[1]"));
}

template <>
ParameterValue JsonFields::read(const ordered_json& json, const std::string& place) const {
  if (json.is_boolean()) return json.get<bool>();
  if (json.is_number_integer()) return read<std::int64_t>(json, place);
  if (json.is_number_float()) return json.get<double>();
  // JSON has no number for what is infinite or undefined; it writes null instead.
  if (json.is_null()) return std::numeric_limits<double>::quiet_NaN();
  return read<std::string>(json, place);
}

}  // namespace raymoval
