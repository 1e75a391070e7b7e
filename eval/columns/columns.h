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
  std::string axis = {};   ///< "range", "height" or "time"; empty: the column is of no band.
  std::string band = {};   ///< "0-10 m".

  [[nodiscard]] std::string text() const;
};

ColumnName parse_column_name(const std::string& name);

/// A share of points that were removed or kept. Tables show columns beside the rates of the
/// protocols.
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
/// - `precision` and `recall` of the set of removed points (moving points are the positive ones),
/// and
///   `residue`, the share of moving points among the kept points;
/// - `rejection`, the share of moving points that are removed (this is the recall), and
///   `preservation`, the share of static points that are kept: in total, by range, by height and by
///   tenths of the scans, "rejection [range 0-10 m]", "rejection [time 0-10 %]".
const std::vector<Column>& general_columns();

/// The columns of the classes that occur in `tally`: `rejection` of moving classes and
/// `preservation` of static ones. Each has a column for all of its points, then one for each range
/// and height band in which it has points, "rejection [moving-car, range 0-10 m]".
std::vector<Column> class_columns(const RemovalTally& tally);

/// Objects with fewer points are in no column of objects.
inline constexpr std::int64_t kFewestObjectPoints = 200;
/// Share of its points from which an object counts as kept, or as gone.
inline constexpr double kWholeObject = 0.95;
/// The columns that tables show beside rates.
inline constexpr const char* kParked = "parked";
inline constexpr const char* kTrails = "trails";
/// The column of the object that loses most. Over several sequences it is the worst of all.
inline constexpr const char* kWorstParked = "parked worst";

/// The columns of objects, which labels with instance ids tell apart. A parked object is static in
/// all scans: no point of its class and instance id moves ("car" and "moving-car" are one class).
/// - `parked`: the share of points kept, as the mean over parked objects, in millionths of an
///   object;
/// - `parked worst`: the same share of the object that loses most;
/// - `parked below 95 %`: the parked objects of which a smaller share is kept;
/// - `trails`: the moving objects of which at least 95 % is removed.
/// Without such objects there are no columns.
std::vector<Column> object_columns(const RemovalTally& tally);

/// A column with its value.
struct ColumnValue {
  std::string name;
  Share share;
  std::string undefined_reason;
};

/// All columns: general ones, those of objects, those of classes.
std::vector<ColumnValue> column_values(const RemovalTally& tally);

}  // namespace raymoval
