// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "eval/columns/removal_tally.h"

namespace raymoval {

enum class Better { kHigher, kLower };

/// A part of a whole, both counts of points.
struct Share {
  std::int64_t part = 0;
  std::int64_t whole = 0;

  /// The share in percent. It has no value if `whole` is 0.
  [[nodiscard]] std::optional<double> percent() const;
};

/// The parts of a column's name, "rejection [moving-car, range 0-10 m]".
struct ColumnName {
  std::string kind;        ///< "rejection".
  std::string group = {};  ///< Class of points, "moving-car"; empty: all points.
  std::string axis = {};   ///< "range" or "height"; empty: the column is of no band.
  std::string band = {};   ///< "0-10 m".

  [[nodiscard]] std::string text() const;
};

ColumnName parse_column_name(const std::string& name);

/// A figure beside the protocols' rates: a share of points, by what a method removed.
struct Column {
  std::string name;
  std::string description;
  Better better = Better::kHigher;
  std::string undefined_reason;  ///< Why there is no value if the whole is 0.
  std::function<Share(const RemovalTally&)> share;
};

/// Raised when a column's value may change.
inline constexpr const char* kColumnsVersion = "1";

/// The columns of any sequence, in order:
/// - `precision` and `recall` of the set of removed points (moving = positive), and `residue`,
///   the share of moving points in what is kept;
/// - `rejection`, moving points that are removed (= recall), and `preservation`, static points that
///   are kept: in total, by range band and by height band, "rejection [0-10 m]".
const std::vector<Column>& general_columns();

/// The columns of the classes that occur in `tally`: `rejection` of moving and `preservation` of
/// static ones, each in total, then by those range and height bands in which it has points,
/// "rejection [moving-car, 0-10 m]".
std::vector<Column> class_columns(const RemovalTally& tally);

/// A column with its value.
struct ColumnValue {
  std::string name;
  Share share;
  std::string undefined_reason;
};

/// All columns, general ones first.
std::vector<ColumnValue> column_values(const RemovalTally& tally);

}  // namespace raymoval
