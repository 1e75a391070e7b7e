// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "benchmark/result/run_record.h"
#include "eval/averages.h"
#include "eval/confidence/reliability.h"

namespace raymoval {

/// Time of a method over all sequences that it finished.
struct MethodTimes {
  std::string cell;
  std::size_t scans = 0;
  double seconds = 0.0;                                ///< Without waiting for scans.
  double load_seconds = 0.0;                           ///< Waiting for scans.
  std::vector<std::pair<std::string, double>> stages;  ///< Seconds, summed over threads.
  int threads = 1;       ///< The largest number; parallel work adds up in `stages`.
  int side_by_side = 1;  ///< The largest number of cells that ran at once.
};

/// A cell that is one point of a sweep.
struct SweptCell {
  std::string cell;
  std::string of;  ///< The swept method, "raymoval:offline".
  std::vector<std::pair<std::string, std::string>> values;

  /// "raymoval:offline over tau0, tau1": the swept method and parameters. Points with the same text
  /// belong to one sweep; a variant can have several sweeps.
  [[nodiscard]] std::string sweep() const;
  /// "tau0=0.2, tau1=0.1".
  [[nodiscard]] std::string point() const;
};

/// The points of a sweep, which all have values of the same parameters.
struct Sweep {
  std::string name;                      ///< SweptCell::sweep().
  std::vector<const SweptCell*> points;  ///< At least one.
};

/// A method with other parameters than its variant, or a sweep of such a method.
struct ChangedMethod {
  std::string name;         ///< Of the method, or SweptCell::of.
  std::string differences;  ///< "range_max = 40 (default 60), tau0 = 0.2 (default 0.3)".

  /// The footnote of tables: "raymoval:offline*: range_max = 40 (default 60)".
  [[nodiscard]] std::string note() const { return name + ": " + differences; }
};

/// Columns of a method, added up over all sequences that it finished.
struct MethodColumns {
  std::string cell;
  bool control = false;
  std::size_t sequences = 0;
  std::vector<std::pair<std::string, Share>> values;

  /// 0 of 0 if there is no such column.
  [[nodiscard]] Share find(const std::string& name) const;
};

/// The confidences of a method against the true shares, over all sequences with confidences.
struct MethodReliability {
  std::string cell;
  std::size_t sequences = 0;
  Reliability all;
};

/// The input of all tables: the cells of results.json, and sums over sequences.
struct RunResults {
  std::string name;
  std::vector<std::string> sequences;
  std::vector<std::string> methods;  ///< Names in the suite, in its order.
  std::vector<std::string> protocols;
  std::vector<Cell> cells;  ///< Without counts by scan.
  std::vector<MethodColumns> columns;
  std::vector<MethodReliability> reliability;  ///< Of methods with confidences.
  std::vector<MethodTimes> times;              ///< Controls are left out.
  std::vector<SweptCell> sweeps;
  std::vector<ChangedMethod> changed;
  /// Names in the suite of methods that were developed on data, by the words for the data.
  std::map<std::string, std::vector<std::string>> developed_on = {};
  std::vector<std::string> missing;  ///< "sequence / method" of cells that were not run.
  std::vector<std::string> control_problems;
  /// Names in the registry of the protocols that the suite calls otherwise, by their names in it.
  std::map<std::string, std::string> protocol_kinds = {};

  /// The name in the registry of the protocol that the suite calls `protocol`.
  [[nodiscard]] const std::string& kind_of(const std::string& protocol) const;
  /// The cell of a sequence and method; null if there is none.
  [[nodiscard]] const Cell* find(const std::string& sequence, const std::string& method) const;
  /// The columns of a method; null if it has none.
  [[nodiscard]] const MethodColumns* columns_of(const std::string& method) const;
  /// The data of a sequence; null if no cell has it.
  [[nodiscard]] const DataRecord* data_of(const std::string& sequence) const;
  /// A rate of a cell; no value if it is undefined or the cell has no result.
  [[nodiscard]] std::optional<double> rate(const std::string& sequence, const std::string& method,
                                           const std::string& protocol,
                                           const std::string& rate) const;
  /// The values of a rate on each sequence.
  [[nodiscard]] SegmentValues values(const std::string& method, const std::string& protocol,
                                     const std::string& rate) const;
  /// The point of a sweep that the method is; null if the method is not swept.
  [[nodiscard]] const SweptCell* swept(const std::string& method) const;
  [[nodiscard]] bool is_swept(const std::string& method) const { return swept(method) != nullptr; }
  [[nodiscard]] bool is_control(const std::string& method) const;
  /// Milliseconds per scan over all sequences that the method finished; none for controls.
  [[nodiscard]] std::optional<double> ms_per_scan(const std::string& method) const;
  /// The peak memory of the method over all sequences, in MiB.
  [[nodiscard]] std::optional<double> peak_mib(const std::string& method) const;
  /// Whether a cell has such a rate by `protocol`.
  [[nodiscard]] bool gives(const std::string& protocol, const std::string& rate) const;
  /// Names of the rates of `protocol` that are shown by default, in order.
  [[nodiscard]] std::vector<std::string> rates_of(const std::string& protocol) const;
  /// The rate by which methods are ranked; empty if `protocol` gives none.
  [[nodiscard]] std::string headline_of(const std::string& protocol) const;
};

/// The part of a run that tables show.
RunResults shown_results(ResultsRecord results);

/// The sweeps of a run, which `results` holds.
std::vector<Sweep> sweeps_of(const RunResults& results);

/// results.csv: rates in percent with 3 decimals, F1 with 4, empty where undefined.
std::string results_csv(const RunResults& results);

/// Keeps only the cells "SEQUENCE/NAME" that fit a pattern, and the sequences and methods with such
/// a cell; all if there are no patterns.
/// @throws UsageError if a pattern fits no cell
void choose_cells(ResultsRecord& results, const std::vector<std::string>& only);

/// Keeps only the scores of `protocols`; all if there are none.
/// @throws UsageError if one of them did not score the run
void choose_protocols(RunResults& results, const std::vector<std::string>& protocols);

}  // namespace raymoval
