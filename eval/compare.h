// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "eval/protocol.h"

namespace raymoval {

/// What must be equal for two results to be comparable, by name: {"parameter tau0", "0.3"}.
using Facts = std::map<std::string, std::string>;

/// What one protocol said of one cell.
struct ComparedScore {
  std::string protocol;  ///< Its name in the suite.
  Facts identity;        ///< Protocol, version and options.
  std::vector<std::pair<std::string, std::int64_t>> counts;
  std::vector<Rate> rates;
};

/// A method on a sequence.
struct ComparedCell {
  std::string sequence;
  std::string name;  ///< Name of the method in the suite.
  bool control = false;
  std::string status = "ok";
  std::string reason;
  Facts identity;  ///< Data and parameters.
  std::string method_version;
  std::vector<ComparedScore> scores;
  std::optional<double> seconds_per_scan;
};

/// All cells of a run, or of a reference.
struct ResultSet {
  std::vector<ComparedCell> cells;
  std::vector<std::string> control_problems;
};

struct ComparisonOptions {
  /// Metric and by how much it may fall, in its own unit (PR in percent, F1 a fraction). Where a
  /// protocol has any of them, these rates are judged instead of all counts.
  std::map<std::string, double> tolerances;
  /// Slower than the reference by more than this factor is worse; without it time is only told.
  std::optional<double> time_band;
};

/// Sentences on all that is not the same.
struct Comparison {
  std::vector<std::string> incomparable;
  std::vector<std::string> worse;
  std::vector<std::string> better;
  std::vector<std::string> moved;  ///< Neither better nor worse, or within tolerance.
  std::vector<std::string> times;
  std::size_t cells = 0;       ///< Cells of the reference.
  std::size_t same_cells = 0;  ///< Of these, cells with equal counts and rates.

  /// kCannotDo if anything is not comparable, else kWorse if anything is worse, else kDone.
  [[nodiscard]] ExitCode verdict() const;
};

/// Compares `run` with `reference` cell by cell. Changed counts are better only if a rate rose,
/// none fell, and every count that masks cannot change is the same; else they are worse. Cells that
/// only the run has are told and not judged.
/// @throws UsageError if a tolerance names a rate that the reference does not have
Comparison compare_results(const ResultSet& run, const ResultSet& reference,
                           const ComparisonOptions& options);

/// The comparison as lines for a reader; the last one is a summary.
std::string comparison_text(const Comparison& comparison);

}  // namespace raymoval
