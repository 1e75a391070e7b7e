// SPDX-License-Identifier: MIT
#include "benchmark/result/record_fields.h"

#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <new>

#include "benchmark/suite/suite_json.h"
#include "core/name.h"

namespace raymoval {

using nlohmann::ordered_json;

ordered_json RecordWriter::json_of(const ParameterValue& value) {
  return std::visit([](const auto& held) { return ordered_json(held); }, value);
}

ordered_json RecordWriter::json_of(const SequenceRequest& place) {
  return to_json(place);
}

RecordReader::RecordReader(const ordered_json& json, const std::string& file, std::string place)
    : json_(json), file_(file), place_(std::move(place)) {
  expect(json.is_object(), "an object", json, place_);
}

bool RecordReader::has(const char* key) const {
  const auto found = json_.find(key);
  return found != json_.end() && !found->is_null();
}

const ordered_json& RecordReader::at(const char* key) const {
  const auto found = json_.find(key);
  if (found == json_.end()) fail(place_of(key), "is missing");
  return *found;
}

std::string RecordReader::place_of(const std::string& key) const {
  return place_.empty() ? key : place_ + "." + key;
}

void RecordReader::fail(const std::string& place, const std::string& problem) const {
  throw FieldError(
      fmt::format("{}: not the results of a run ({}{}). Run `raymoval run` again with "
                  "the same --out.",
                  file_, place.empty() ? "" : place + ": ", problem));
}

void RecordReader::expect(bool good, const char* what, const ordered_json& json,
                          const std::string& place) const {
  if (good) return;
  constexpr std::size_t kMost = 40;
  std::string found = json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  if (found.size() > kMost) found = std::string("a long ") + json.type_name();
  fail(place, fmt::format("expected {}, found {}", what, found));
}

void RecordReader::check_schema_version() const {
  std::int64_t version = 0;
  field("schema_version", version);
  if (version == kSchemaVersion) return;
  throw SchemaVersionError(
      fmt::format("{}: schema version {}, expected {}. Run `raymoval run` again with this version.",
                  file_, version, kSchemaVersion));
}

void RecordReader::name(const char* key, std::string& value) const {
  field(key, value);
  const std::string problem = value.empty() ? "" : name_problem(value);
  if (!problem.empty()) {
    fail(place_of(key), fmt::format("the name {}; expected {}", problem, kNameForm));
  }
}

void RecordReader::limit(const char* key, double& value, double none) const {
  value = none;
  optional(key, value);
}

void RecordReader::read(const Json& json, const std::string& place, bool& value) const {
  expect(json.is_boolean(), "true or false", json, place);
  value = json.get<bool>();
}

void RecordReader::read(const Json& json, const std::string& place, std::uint64_t& value) const {
  const bool whole = json.is_number_integer();
  const bool good = whole && (json.is_number_unsigned() || json.get<std::int64_t>() >= 0);
  expect(good, "a whole number of at least 0", json, place);
  value = json.get<std::uint64_t>();
}

void RecordReader::read(const Json& json, const std::string& place, std::int64_t& value) const {
  // Every JSON reader holds these numbers exactly. Sums and differences of such counts fit too.
  constexpr std::int64_t kMost = std::int64_t{1} << 53;
  expect(json.is_number_integer(), "a whole number", json, place);
  value = json.get<std::int64_t>();  // Negative for numbers beyond 63 bits.
  const bool fits = value >= (json.is_number_unsigned() ? 0 : -kMost) && value <= kMost;
  expect(fits, "a whole number of 53 bits", json, place);
}

void RecordReader::read(const Json& json, const std::string& place, int& value) const {
  std::int64_t wide = 0;
  read(json, place, wide);
  value = static_cast<int>(wide);
  expect(value == wide, "a whole number of 32 bits", json, place);
}

void RecordReader::read(const Json& json, const std::string& place, std::uint16_t& value) const {
  std::uint64_t wide = 0;
  read(json, place, wide);
  value = static_cast<std::uint16_t>(wide);
  expect(value == wide, "a whole number up to 65535", json, place);
}

void RecordReader::read(const Json& json, const std::string& place, double& value) const {
  expect(json.is_number(), "a number", json, place);
  value = json.get<double>();
}

void RecordReader::read(const Json& json, const std::string& place, std::string& value) const {
  expect(json.is_string(), "a text", json, place);
  value = json.get<std::string>();
}

void RecordReader::read(const Json& json, const std::string& place, CellStatus& value) const {
  std::string name;
  read(json, place, name);
  expect(status_called(name).has_value(), "the status of a cell, such as \"ok\"", json, place);
  value = *status_called(name);
}

void RecordReader::read(const Json& json, const std::string& place, ParameterValue& value) const {
  const auto read_held = [&](auto held) {
    read(json, place, held);
    value = held;
  };
  // JSON has no infinite or undefined numbers; null is written instead.
  if (json.is_null()) return void(value = std::numeric_limits<double>::quiet_NaN());
  if (json.is_boolean()) return read_held(false);
  if (json.is_number_integer()) return read_held(std::int64_t{0});
  if (json.is_number_float()) return read_held(0.0);
  read_held(std::string());
}

void RecordReader::read(const Json& json, const std::string& place, SequenceRequest& value) const {
  try {
    value = place_from(json);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    fail(place, error.what());
  }
}

void RecordReader::read(const Json& json, const std::string& place,
                        std::pair<double, double>& value) const {
  expect(json.is_array() && json.size() == 2, "two numbers", json, place);
  read(json[0], place + "[0]", value.first);
  read(json[1], place + "[1]", value.second);
}

}  // namespace raymoval
