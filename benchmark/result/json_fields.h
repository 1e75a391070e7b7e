// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "benchmark/result/sealed_json.h"
#include "core/error.h"

namespace raymoval {

/// A field of a result file is missing or of the wrong type.
class FieldError : public DataError {
 public:
  using DataError::DataError;
};

/// A result file is of another version of its layout.
class SchemaVersionError : public DataError {
 public:
  using DataError::DataError;
};

/// A JSON object of a result file, read field by field. Every fault is a FieldError that names the
/// file and the field: "results.json: not the results of a run (cells[3].status: expected a text,
/// found 7). Run ...".
///
/// A `Value` is one of bool, int, std::int64_t, std::uint64_t, double, std::string, ParameterValue,
/// JsonFields (an object), std::optional<double> (a number or null) and
/// std::optional<std::pair<double, double>> (a list of two numbers, or null).
class JsonFields {
 public:
  /// Both have to live as long as this object.
  /// @param place where the object stands in its file, "cells[3].method"; empty for all of it
  /// @throws FieldError if it is no object
  JsonFields(const nlohmann::ordered_json& json, const std::string& file, std::string place = "");

  /// Whether there is such a field and it is not null.
  [[nodiscard]] bool has(const char* key) const;

  /// @throws FieldError if the field is missing or of another type
  template <class Value>
  [[nodiscard]] Value get(const char* key) const {
    return read<Value>(at(key), place_of(key));
  }

  /// The same; no value if the field is missing or null.
  template <class Value>
  [[nodiscard]] std::optional<Value> find(const char* key) const {
    if (!has(key)) return std::nullopt;
    return get<Value>(key);
  }

  /// The items of a list.
  template <class Value>
  [[nodiscard]] std::vector<Value> list(const char* key) const {
    std::vector<Value> values;
    const nlohmann::ordered_json& items = list_at(key);
    for (std::size_t i = 0; i < items.size(); ++i) {
      values.push_back(read<Value>(items[i], place_of(key) + "[" + std::to_string(i) + "]"));
    }
    return values;
  }

  /// Names and values of the object in a field, in their order.
  template <class Value>
  [[nodiscard]] std::vector<std::pair<std::string, Value>> named(const char* key) const {
    std::vector<std::pair<std::string, Value>> values;
    const JsonFields object = get<JsonFields>(key);
    for (const auto& [name, json] : object.json_->items()) {
      values.emplace_back(name, read<Value>(json, object.place_of(name)));
    }
    return values;
  }

  /// Says what is wrong with a field. @throws FieldError
  [[noreturn]] void fail(const std::string& key, const std::string& problem) const;

  /// @throws SchemaVersionError unless the field "schema_version" is that of this program
  void check_schema_version() const;

 private:
  template <class Value>
  [[nodiscard]] Value read(const nlohmann::ordered_json& json, const std::string& place) const;
  [[nodiscard]] const nlohmann::ordered_json& at(const char* key) const;
  [[nodiscard]] const nlohmann::ordered_json& list_at(const char* key) const;
  [[nodiscard]] std::string place_of(const std::string& key) const;
  /// @param good whether `json` is what was expected
  void expect(bool good, const char* what, const nlohmann::ordered_json& json,
              const std::string& place) const;
  [[noreturn]] void fail_at(const std::string& place, const std::string& problem) const;

  const nlohmann::ordered_json* json_;
  const std::string* file_;
  std::string place_;
};

/// Reads a whole sealed file with a function that takes its fields.
/// @throws DataError if it is missing or damaged, FieldError, SchemaVersionError
template <class Read>
auto read_sealed_as(const std::filesystem::path& file, Read read) {
  const nlohmann::ordered_json json = read_sealed(file);
  const std::string name = file.string();
  const JsonFields fields(json, name);
  fields.check_schema_version();
  return read(fields);
}

}  // namespace raymoval
