// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "eval/columns.h"

namespace raymoval {

/// Rates of one cell by one protocol, by name ("PR"); without a value where undefined.
using RateValues = std::map<std::string, std::optional<double>>;

/// A row of results.csv: a cell scored by a protocol.
struct ResultRow {
  std::string sequence;
  std::string cell;  ///< Name of the method in the suite, "raymoval:online".
  std::string method;
  std::string variant;
  std::string protocol;
  std::string status;
  bool control = false;
  RateValues rates;  ///< Empty unless the status is "ok".
  /// Low and high end by rate, where they are defined.
  std::map<std::string, std::pair<double, double>> intervals;
  std::optional<double> seconds_per_scan;
  std::optional<double> peak_memory_mib;
  std::string mask_digest = {};  ///< Of what was removed; equal masks have equal digests.
};

/// Time of a method over all sequences that it finished.
struct MethodTimes {
  std::string cell;
  std::size_t scans = 0;
  double seconds = 0.0;                                ///< Without waiting for scans.
  double load_seconds = 0.0;                           ///< Waiting for scans.
  std::vector<std::pair<std::string, double>> stages;  ///< Seconds of each stage.
  int repeats = 1;  ///< So many runs were made; the times are those of the median one.
};

/// A cell without a result.
struct FailedCell {
  std::string sequence;
  std::string cell;
  std::string status;
  std::string reason;
  std::string last_output;  ///< Last line that the method printed.
};

/// A cell that is one point of a sweep.
struct SweptCell {
  std::string cell;
  std::string of;  ///< What is swept, "raymoval:offline".
  std::vector<std::pair<std::string, std::string>> values;
};

/// Columns of a method, added up over all sequences that it finished.
struct MethodColumns {
  std::string cell;
  bool control = false;
  std::size_t sequences = 0;
  std::vector<std::pair<std::string, Share>> values;

  /// Nothing of nothing if there is no such column.
  [[nodiscard]] Share find(const std::string& name) const;
};

/// What tables are made of, read from results.json.
struct RunResults {
  std::string name;
  std::vector<std::string> sequences;
  std::vector<std::string> cells;  ///< Names of the methods, in the order of the suite.
  std::vector<std::string> protocols;
  std::vector<ResultRow> rows;
  std::vector<MethodColumns> columns;
  std::vector<MethodTimes> times;  ///< Controls are left out.
  std::vector<SweptCell> sweeps;
  std::vector<FailedCell> failures;
  std::vector<std::string> missing;  ///< "sequence / method" of cells that were not run.
  std::vector<std::string> control_problems;

  /// The row of a sequence, cell and protocol; null if there is none.
  [[nodiscard]] const ResultRow* find(const std::string& sequence, const std::string& cell,
                                      const std::string& protocol) const;
  [[nodiscard]] bool is_swept(const std::string& cell) const;
};

/// @param results content of results.json
/// @throws DataError if a field is missing or of the wrong type, or the schema is another
RunResults parse_results(const nlohmann::ordered_json& results, const std::string& where);

/// results.csv: rates in percent with 3 decimals, F1 with 4, empty where undefined.
std::string results_csv(const RunResults& results);

/// A rate as it stands in tables: "98.123", F1 "0.9812".
std::string rate_text(const std::string& rate, double value);

/// Leaves only what was scored by `protocols`; all of it if there are none.
/// @throws UsageError if the run was not scored by one of them
void choose_protocols(RunResults& results, const std::vector<std::string>& protocols);

}  // namespace raymoval
