// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
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

/// Reads a sealed cell.json. @throws DataError if it is missing, damaged or of another version
Cell read_cell(const std::filesystem::path& file);
void write_cell(const std::filesystem::path& file, const Cell& cell);

/// Hash of all inputs that determine the counts of a cell. Any change changes the key.
std::string cell_key(const CellIdentity& identity);

/// A parameter as in result files: 1.0 where `parameter_text` gives 1, a text in quotes.
std::string value_text(const ParameterValue& value);
/// The value as text; a text has no quotes.
std::string plain_text(const ParameterValue& value);

}  // namespace raymoval
