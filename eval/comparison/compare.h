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

/// The score of one cell by one protocol.
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
  int side_by_side = 1;  ///< Number of cells that ran at once when it was timed.
};

/// All cells of a run, or of a reference.
struct ResultSet {
  std::vector<ComparedCell> cells;
  std::vector<std::string> control_problems;
  std::string machine = {};  ///< The machine on which times were measured; empty if unknown.
};

struct ComparisonOptions {
  /// Tolerances by rate, in the unit of the rate (PR in percent, F1 a fraction). If a protocol has
  /// any of these rates, they decide instead of all counts.
  std::map<std::string, double> tolerances;
  /// A run that is slower than the reference by more than this factor is worse. Without the factor
  /// times are shown and decide nothing.
  std::optional<double> time_band;
  /// Cells that differ in parameters are compared by their rates, none of which may get worse by
  /// more than its tolerance; if no rate of a protocol has one, none may get worse at all. Without
  /// this option such cells are not comparable.
  bool across_parameters = false;
  /// The same for cells that differ in the method's version. Without it, their counts must be
  /// equal.
  bool across_version = false;
};

/// The result of a comparison, from good to bad.
enum class Change { kSame, kBetter, kMoved, kWorse, kIncomparable };

/// "same", "better", "moved", "worse", "not comparable".
const char* change_name(Change change);

/// A rate of the reference, and the same rate of the run.
struct RateChange {
  std::string name;
  std::optional<double> before, after;  ///< Nothing if it is undefined.
  std::optional<double> tolerance;      ///< Empty: the rate decides nothing.
  /// kMoved if it decides nothing, or if it is not known which direction is better.
  Change change = Change::kSame;
};

/// A count that changed; nothing where one side lacks it.
struct CountChange {
  std::string name;
  std::optional<std::int64_t> before, after;
};

/// The comparison of one cell by one protocol; the cell may be missing in the reference.
struct ScoreComparison {
  std::string sequence;
  std::string name;
  std::string protocol;  ///< Empty if neither side has a score of this cell.
  Change change = Change::kSame;
  std::vector<std::string> reasons;  ///< Reasons other than rates and counts: "missing in the run".
  std::vector<std::string> across;   ///< Parameters or version that differ and were to differ.
  std::vector<RateChange> rates;     ///< All of the reference, if both sides have a score.
  std::vector<CountChange> counts;
};

/// Times of a cell on both sides.
struct TimeChange {
  std::string sequence;
  std::string name;
  std::optional<double> before, after;  ///< Seconds per scan.
  /// kWorse: it is beyond the time band; kIncomparable: there is a band, and one side has no time
  /// or the two were not taken alike.
  Change change = Change::kSame;
  int before_side_by_side = 1, after_side_by_side = 1;  ///< Cells that ran at once.

  /// Whether as many cells ran at once on both sides. Else nothing follows from the ratio.
  [[nodiscard]] bool has_equal_load() const { return before_side_by_side == after_side_by_side; }

  /// Time of the run divided by the reference's; only if both sides have a time.
  [[nodiscard]] double ratio() const { return *after / *before; }
};

/// A sentence of a comparison, and the cell that it is about.
struct ComparisonLine {
  Change change = Change::kSame;
  std::string sequence, name, protocol;  ///< Empty where it is about more than that.
  std::string text;
};

/// All differences, in two forms: as sentences, and in parts for other formats.
struct Comparison {
  std::vector<std::string> incomparable;
  std::vector<std::string> worse;
  std::vector<std::string> better;
  std::vector<std::string> moved;  ///< Neither better nor worse, or within tolerance.
  std::vector<std::string> times;
  std::size_t cells = 0;       ///< Cells of the reference.
  std::size_t same_cells = 0;  ///< Of these, cells with equal counts and rates.

  std::vector<ComparisonLine> lines;  ///< The sentences except those on times, with their cells.
  std::vector<ScoreComparison> scores;
  std::vector<TimeChange> time_changes;
  /// Whether all cells would be comparable with `across_parameters`.
  bool parameters_only = false;

  /// kCannotDo if anything is not comparable, else kWorse if anything is worse, else kDone.
  [[nodiscard]] ExitCode verdict() const;
  /// The verdict in words: "not comparable", "worse", "better, no regression", "no regression".
  [[nodiscard]] std::string verdict_words() const;
};

/// Compares `run` with `reference` cell by cell. Changed counts are better only if a rate improved,
/// none got worse, and every count that masks cannot change is the same; else they are worse. Cells
/// that only the run has are shown and do not change the verdict, nor do rates without a known
/// better direction.
/// @throws UsageError if a tolerance names a rate that the reference does not have, or one whose
/// better direction is not known; if there is a time band and the reference has no times
Comparison compare_results(const ResultSet& run, const ResultSet& reference,
                           const ComparisonOptions& options);

/// The comparison as lines for a reader. A sentence that holds for several cells appears once, and
/// the last line is a summary.
std::string comparison_text(const Comparison& comparison);

/// "F1 0.9368 -> 0.9400 (+0.0032)", "RR 90.0000 -> undefined".
std::string change_text(const RateChange& rate);
/// "removed_points 5000 -> 4999 (-1)", "count x is missing".
std::string change_text(const CountChange& count);
/// "times were not taken alike: with 2 cells at once (run --jobs), the reference with 1".
std::string side_by_side_text(const TimeChange& time);
/// "1.59 times the reference (29.0 ms per scan, was 18.3)".
std::string change_text(const TimeChange& time);

}  // namespace raymoval
