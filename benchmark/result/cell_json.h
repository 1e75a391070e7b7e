// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "benchmark/result/cell.h"

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

/// The content of cell.json without its checksum, and back. Keys, their order and the texts of
/// numbers are fixed: a cell that is read and written again has the same bytes.
nlohmann::ordered_json to_json(const Cell& cell);
/// @param file stands in messages
/// @throws FieldError naming the file and the field
Cell cell_from(const nlohmann::ordered_json& json, const std::string& file);

/// Reads a sealed cell.json. @throws DataError if it is missing, damaged or of another version
Cell read_cell(const std::filesystem::path& file);
void write_cell(const std::filesystem::path& file, const Cell& cell);

/// The same of a further run, timing-2.json.
RepeatRecord read_repeat(const std::filesystem::path& file);
void write_repeat(const std::filesystem::path& file, const RepeatRecord& repeat);

/// Hash of all that the counts of a cell depend on. Any change changes the key.
std::string cell_key(const CellIdentity& identity);

// Parts of a cell, which stand in other files and in what commands print.

nlohmann::ordered_json to_json(const DataRecord& data);
nlohmann::ordered_json to_json(const MethodRecord& method);
nlohmann::ordered_json to_json(const ProtocolRecord& protocol);
nlohmann::ordered_json to_json(const ColumnRecord& columns);
nlohmann::ordered_json to_json(const Measurement& measured);
Measurement measurement_from(const nlohmann::ordered_json& json, const std::string& place);
/// Counts and rates; an undefined rate is null, and its reason stands below "undefined".
nlohmann::ordered_json to_json(const ProtocolResult& result);

/// A parameter as it stands in result files: 1.0 where `parameter_text` says 1, a text in quotes.
std::string value_text(const ParameterValue& value);

}  // namespace raymoval
