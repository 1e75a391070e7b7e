// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "benchmark/result/cell_json.h"
#include "benchmark/result/sealed_json.h"
#include "benchmark/suite/suite.h"

namespace raymoval {

// A record has a function `describe(visitor, record)` that names its fields once, in the order of
// the file. A RecordWriter makes JSON of them, and a RecordReader reads them again:
//
//   template <class Visitor>
//   void describe(Visitor& visitor, typename Visitor::template Of<EgoRecord> ego) {
//     visitor.field("asked", ego.asked);
//     visitor.field("left_out", ego.left_out);
//   }
//
// A value is a number, a text, true or false, a described record, an optional value (which may be
// null), a list of values, or a list of names with values (an object).

class RecordWriter;

template <class Value>
concept Described = requires(RecordWriter& writer, const Value& value) {
  describe(writer, value);
};

template <class Item>
using Named = std::vector<std::pair<std::string, Item>>;

class RecordWriter {
 public:
  template <class Record>
  using Of = const Record&;

  nlohmann::ordered_json json = nlohmann::ordered_json::object();

  /// A required field.
  template <class Value>
  void field(const char* key, const Value& value) {
    json[key] = json_of(value);
  }
  /// A name of a sequence, method, variant, protocol or suite, see core/name.h; or an empty text.
  void name(const char* key, const std::string& value) { field(key, value); }
  /// A field that is null if the value is empty.
  template <class Value>
  void nullable(const char* key, const Value& value) {
    json[key] = nullptr;
    optional(key, value);
  }
  /// A field that is left out if the value is empty.
  template <class Value>
  void optional(const char* key, const Value& value) {
    if constexpr (requires { value.empty(); }) {
      if (!value.empty()) field(key, value);
    } else {
      if (value) field(key, *value);
    }
  }
  /// A number that is null from `none` on.
  void limit(const char* key, double value, double none) {
    nullable(key, value < none ? std::optional<double>(value) : std::nullopt);
  }
  /// An object whose fields belong to the same record.
  template <class Describe>
  void nested(const char* key, Describe describe_part) {
    RecordWriter part;
    describe_part(part);
    json[key] = std::move(part.json);
  }
  /// Makes a field required that other records may lack.
  void require(const char*) const {}
  /// The version of a whole file, which `read_sealed_with` checks.
  void schema_version() { field("schema_version", kSchemaVersion); }

 private:
  static nlohmann::ordered_json json_of(CellStatus status) { return status_name(status); }
  static nlohmann::ordered_json json_of(const ParameterValue& value);
  static nlohmann::ordered_json json_of(const SequenceRequest& place);
  template <class Value>
  static nlohmann::ordered_json json_of(const std::optional<Value>& value) {
    return value ? json_of(*value) : nlohmann::ordered_json(nullptr);
  }
  template <class Value>
  static nlohmann::ordered_json json_of(const Value& value) {
    return value;
  }
  template <Described Record>
  static nlohmann::ordered_json json_of(const Record& record) {
    RecordWriter writer;
    describe(writer, record);
    return std::move(writer.json);
  }
  template <class Item>
  static nlohmann::ordered_json json_of(const std::vector<Item>& items) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Item& item : items) list.push_back(json_of(item));
    return list;
  }
  template <class Item>
  static nlohmann::ordered_json json_of(const Named<Item>& items) {
    nlohmann::ordered_json object = nlohmann::ordered_json::object();
    for (const auto& [name, item] : items) object[name] = json_of(item);
    return object;
  }
};

/// Reads what a RecordWriter wrote. Every fault is a FieldError that names the file and the field:
/// "results.json: not the results of a run (cells[3].status: expected a text, found 7). Run ...".
class RecordReader {
 public:
  template <class Record>
  using Of = Record&;

  /// `json` and `file` must outlive this object.
  /// @param place of the object in its file, "cells[3].method"; empty for the whole file
  RecordReader(const nlohmann::ordered_json& json, const std::string& file, std::string place = "");

  template <class Value>
  void field(const char* key, Value& value) const {
    read(at(key), place_of(key), value);
  }
  void name(const char* key, std::string& value) const;
  template <class Value>
  void nullable(const char* key, Value& value) const {
    optional(key, value);
  }
  template <class Value>
  void optional(const char* key, Value& value) const {
    if (has(key)) field(key, value);
  }
  void limit(const char* key, double& value, double none) const;
  template <class Describe>
  void nested(const char* key, Describe describe_part) const {
    RecordReader part(at(key), file_, place_of(key));
    describe_part(part);
  }
  void require(const char* key) const { (void)at(key); }
  void schema_version() const {}
  /// @throws SchemaVersionError unless the field "schema_version" is that of this program
  void check_schema_version() const;
  /// @throws FieldError that describes the problem of a field
  [[noreturn]] void fail(const std::string& place, const std::string& problem) const;

 private:
  using Json = nlohmann::ordered_json;
  /// Whether the field exists and is not null.
  [[nodiscard]] bool has(const char* key) const;
  [[nodiscard]] const Json& at(const char* key) const;
  [[nodiscard]] std::string place_of(const std::string& key) const;
  /// @param good whether `json` is as expected
  void expect(bool good, const char* what, const Json& json, const std::string& place) const;

  void read(const Json& json, const std::string& place, bool& value) const;
  void read(const Json& json, const std::string& place, int& value) const;
  void read(const Json& json, const std::string& place, std::uint16_t& value) const;
  void read(const Json& json, const std::string& place, std::int64_t& value) const;
  void read(const Json& json, const std::string& place, std::uint64_t& value) const;
  void read(const Json& json, const std::string& place, double& value) const;
  void read(const Json& json, const std::string& place, std::string& value) const;
  void read(const Json& json, const std::string& place, CellStatus& value) const;
  void read(const Json& json, const std::string& place, ParameterValue& value) const;
  void read(const Json& json, const std::string& place, SequenceRequest& value) const;
  void read(const Json& json, const std::string& place, std::pair<double, double>& value) const;
  template <Described Record>
  void read(const Json& json, const std::string& place, Record& record) const {
    RecordReader reader(json, file_, place);
    describe(reader, record);
  }
  template <class Value>
  void read(const Json& json, const std::string& place, std::optional<Value>& value) const {
    if (!json.is_null()) read(json, place, value.emplace());
  }
  template <class Item>
  void read(const Json& json, const std::string& place, std::vector<Item>& items) const {
    expect(json.is_array(), "a list", json, place);
    items.clear();
    for (std::size_t i = 0; i < json.size(); ++i) {
      read(json[i], place + "[" + std::to_string(i) + "]", items.emplace_back());
    }
  }
  template <class Item>
  void read(const Json& json, const std::string& place, Named<Item>& items) const {
    expect(json.is_object(), "an object", json, place);
    items.clear();
    for (const auto& [name, item] : json.items()) {
      items.emplace_back(name, Item());
      read(item, place + "." + name, items.back().second);
    }
  }

  const Json& json_;
  const std::string& file_;
  std::string place_;
};

template <Described Record>
nlohmann::ordered_json to_json(const Record& record) {
  RecordWriter writer;
  describe(writer, record);
  return std::move(writer.json);
}

/// @param file for messages
template <class Record>
Record read_as(const nlohmann::ordered_json& json, const std::string& file) {
  RecordReader reader(json, file);
  Record record;
  describe(reader, record);
  return record;
}

/// Reads a whole sealed file with a function of its JSON and its name.
/// @throws DataError if it is missing or damaged; FieldError; SchemaVersionError
template <class From>
auto read_sealed_with(const std::filesystem::path& file, From from) {
  const nlohmann::ordered_json json = read_sealed(file);
  const std::string name = file.string();
  RecordReader(json, name).check_schema_version();
  return from(json, name);
}

}  // namespace raymoval
