// SPDX-License-Identifier: MIT
#include "eval/comparison/compare.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <string_view>

#include "core/text.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

/// Whether it is known which direction of a rate is better. Other rates are shown in a comparison
/// and decide nothing.
bool has_known_direction(const std::string& rate) {
  return find_rate_spec(rate) != nullptr;
}

/// Rates follow from the counts. A larger difference than this is not a matter of rounding.
constexpr double kRateNoise = 1e-9;

template <class Value>
const Value* find_value(const std::vector<std::pair<std::string, Value>>& list,
                        const std::string& name) {
  for (const auto& [key, value] : list) {
    if (key == name) return &value;
  }
  return nullptr;
}

const Rate* find_rate(const std::vector<Rate>& rates, const std::string& name) {
  for (const Rate& rate : rates) {
    if (rate.name == name) return &rate;
  }
  return nullptr;
}

/// Facts on a changed score that are not in its `ScoreComparison`.
struct ScoreMovement {
  bool by_rates = false;  ///< Rates decide, and counts may differ.
  bool rate_improved = false;
  bool rate_worsened = false;  ///< Or it is defined on one side only.
  bool beyond_tolerance = false;
  bool truth_changed = false;  ///< A count that no mask can change has changed.
};

bool has_tolerance(const ComparedScore& reference, const ComparisonOptions& options) {
  return std::any_of(reference.rates.begin(), reference.rates.end(),
                     [&](const Rate& rate) { return options.tolerances.contains(rate.name); });
}

/// The tolerance of a rate; empty if the rate decides nothing. Across parameters, all rates decide
/// if the protocol has no rate with a tolerance.
std::optional<double> tolerance_of(const std::string& rate, const ComparedScore& reference,
                                   const ComparisonOptions& options, bool across) {
  const auto given = options.tolerances.find(rate);
  if (given != options.tolerances.end()) return given->second;
  if (across && !has_tolerance(reference, options) && has_known_direction(rate)) return 0.0;
  return std::nullopt;
}

/// Sets the change of a rate whose values and tolerance are known.
void classify_rate_change(RateChange& rate, ScoreMovement& movement) {
  if (rate.before.has_value() == rate.after.has_value() &&
      (!rate.after || std::abs(*rate.after - *rate.before) <= kRateNoise)) {
    return;
  }
  rate.change = Change::kMoved;
  const RateSpec* spec = find_rate_spec(rate.name);
  if (spec == nullptr) return;
  // A rate that is defined on one side only may be worse.
  const bool defined = rate.before && rate.after;
  const bool improved = defined && spec->is_better(*rate.after, *rate.before);
  (improved ? movement.rate_improved : movement.rate_worsened) = true;
  if (improved) {
    rate.change = Change::kBetter;
  } else if (!rate.tolerance) {
    rate.change = movement.by_rates ? Change::kMoved : Change::kWorse;
  } else if (!defined || std::abs(*rate.before - *rate.after) > *rate.tolerance + kRateNoise) {
    rate.change = Change::kWorse;
    movement.beyond_tolerance = true;
  }
}

std::vector<CountChange> changed_counts(const ComparedScore& run, const ComparedScore& reference) {
  std::vector<CountChange> changes;
  for (const auto& [name, before] : reference.counts) {
    const std::int64_t* after = find_value(run.counts, name);
    if (after != nullptr && *after == before) continue;
    changes.push_back({name, before, std::nullopt});
    if (after != nullptr) changes.back().after = *after;
  }
  for (const auto& [name, after] : run.counts) {
    if (find_value(reference.counts, name) == nullptr)
      changes.push_back({name, std::nullopt, after});
  }
  return changes;
}

Change change_of(const ComparedCell& cell, const ScoreMovement& movement) {
  // The mask of a control is known: any change is a fault of the program.
  if (movement.truth_changed || cell.control) return Change::kWorse;
  if (movement.by_rates ? movement.beyond_tolerance : movement.rate_worsened) return Change::kWorse;
  if (movement.rate_improved && !movement.rate_worsened) return Change::kBetter;
  return movement.by_rates ? Change::kMoved : Change::kWorse;
}

/// Compares the scores of one cell by one protocol on both sides, which are comparable.
/// @param cell of the run
/// @param score has its cell, protocol and what differs across; gets rates, counts and the change
/// @return the changes in words; empty if there are none
std::string compare_scores(const ComparedCell& cell, const ComparedScore& run,
                           const ComparedScore& reference, const ComparisonOptions& options,
                           ScoreComparison& score) {
  const bool across = !score.across.empty();
  ScoreMovement movement;
  movement.by_rates = across || has_tolerance(reference, options);
  std::vector<std::string> changes;
  for (const Rate& rate : reference.rates) {
    const Rate* after = find_rate(run.rates, rate.name);
    score.rates.push_back({rate.name, rate.value, after == nullptr ? std::nullopt : after->value,
                           tolerance_of(rate.name, reference, options, across), Change::kSame});
    classify_rate_change(score.rates.back(), movement);
    if (score.rates.back().change != Change::kSame) {
      changes.push_back(change_text(score.rates.back()));
    }
  }
  score.counts = changed_counts(run, reference);
  for (const CountChange& count : score.counts) {
    movement.truth_changed |= is_truth_count(count.name) || !count.before || !count.after;
    // Across parameters it is expected that other counts differ.
    if (!across || movement.truth_changed) changes.push_back(change_text(count));
  }
  if (score.counts.empty() && changes.empty()) return "";
  score.change = change_of(cell, movement);
  return changes.empty() ? "counts moved, and no rate with them" : join(changes);
}

const ComparedCell* find_cell(const ResultSet& set, const ComparedCell& wanted) {
  for (const ComparedCell& cell : set.cells) {
    if (cell.sequence == wanted.sequence && cell.name == wanted.name) return &cell;
  }
  return nullptr;
}

/// The cell of the run for a cell of the reference: the cell of the same name, else the same method
/// with a changed parameter, whose name has a '*' more or less.
const ComparedCell* partner_of(const ResultSet& run, const ResultSet& reference,
                               const ComparedCell& wanted) {
  if (const ComparedCell* same = find_cell(run, wanted)) return same;
  const auto plain = [](std::string name) {
    std::erase(name, '*');
    return name;
  };
  for (const ComparedCell& cell : run.cells) {
    const bool alike = cell.sequence == wanted.sequence && plain(cell.name) == plain(wanted.name);
    if (alike && find_cell(reference, cell) == nullptr) return &cell;
  }
  return nullptr;
}

const ComparedScore* find_score(const ComparedCell& cell, const std::string& protocol) {
  for (const ComparedScore& score : cell.scores) {
    if (score.protocol == protocol) return &score;
  }
  return nullptr;
}

std::string title(const ComparedCell& cell) {
  return cell.sequence + " / " + cell.name;
}

/// The facts of `run` and `reference` that differ, as name and text.
/// @param common_only leaves out facts that one of them lacks
std::vector<std::pair<std::string, std::string>> fact_differences(const Facts& run,
                                                                  const Facts& reference,
                                                                  bool common_only) {
  std::vector<std::pair<std::string, std::string>> differences;
  for (const auto& [name, value] : reference) {
    const auto found = run.find(name);
    if (found == run.end()) {
      if (common_only) continue;
      differences.emplace_back(name, name + " is missing, the reference has " + value);
    } else if (found->second != value) {
      differences.emplace_back(name,
                               name + " is " + found->second + ", the reference has " + value);
    }
  }
  for (const auto& [name, value] : run) {
    if (common_only || reference.contains(name)) continue;
    differences.emplace_back(name, name + " is " + value + ", the reference has none");
  }
  return differences;
}

bool is_parameter(std::string_view fact) {
  return fact.starts_with("parameter ");
}

/// Compares cell by cell and collects the differences.
class Comparer {
 public:
  explicit Comparer(const ComparisonOptions& options) : options_(options) {}

  Comparison compare(const ResultSet& run, const ResultSet& reference) {
    result_.cells = reference.cells.size();
    if (reference.cells.empty()) add_line(Change::kIncomparable, {}, "the reference has no cell");
    check_times(reference);
    for (const std::string& problem : reference.control_problems) {
      add_line(Change::kIncomparable, {}, "the reference is unsound: " + problem);
    }
    for (const std::string& problem : run.control_problems) add_line(Change::kWorse, {}, problem);
    std::set<const ComparedCell*> partners;
    for (const ComparedCell& cell : reference.cells) {
      const ComparedCell* found = partner_of(run, reference, cell);
      partners.insert(found);
      if (found == nullptr) {
        add_cell_line(Change::kIncomparable, cell, cell, "missing in the run");
      } else {
        compare_cell(*found, cell);
      }
    }
    for (const ComparedCell& cell : run.cells) {
      if (partners.contains(&cell)) continue;
      add_cell_line(Change::kMoved, cell, cell, "not in the reference, not compared");
    }
    if (!load_difference_.empty()) result_.times.push_back("not compared: " + load_difference_);
    if (!result_.times.empty() && run.machine != reference.machine) {
      result_.times.push_back("the times are of different machines: " + run.machine +
                              "; the reference: " + reference.machine);
    }
    result_.parameters_only = parameters_differ_ && !more_differs_;
    return std::move(result_);
  }

 private:
  void check_times(const ResultSet& reference) {
    if (!options_.time_band || reference.cells.empty()) return;
    timeless_ = std::none_of(reference.cells.begin(), reference.cells.end(),
                             [](const auto& cell) { return cell.seconds_per_scan.has_value(); });
    if (!timeless_) return;
    add_line(Change::kIncomparable, {},
             "the reference has no times for --time-band; make it again with --update "
             "--with-times, or leave --time-band out");
  }

  /// Adds a sentence to its list. `of` has the cell and protocol of the sentence, if any.
  void add_line(Change change, const ScoreComparison& of, const std::string& text) {
    std::vector<std::string>& list = change == Change::kIncomparable ? result_.incomparable
                                     : change == Change::kWorse      ? result_.worse
                                     : change == Change::kBetter     ? result_.better
                                                                     : result_.moved;
    std::string where = of.sequence.empty() ? "" : of.sequence + " / " + of.name;
    if (!of.protocol.empty()) where += ", " + of.protocol;
    list.push_back(where.empty() ? text : where + ": " + text);
    result_.lines.push_back({change, of.sequence, of.name, of.protocol, text});
    if (change == Change::kIncomparable && !adding_parameters_) more_differs_ = true;
  }

  /// Adds the same sentence for a cell as a whole, and for each score that `scored` has of it.
  void add_cell_line(Change change, const ComparedCell& cell, const ComparedCell& scored,
                     const std::string& text) {
    add_line(change, {cell.sequence, cell.name, "", change, {}, {}, {}, {}}, text);
    if (scored.scores.empty()) {
      result_.scores.push_back({cell.sequence, cell.name, "", change, {text}, {}, {}, {}});
    }
    for (const ComparedScore& score : scored.scores) {
      result_.scores.push_back(
          {cell.sequence, cell.name, score.protocol, change, {text}, {}, {}, {}});
    }
  }

  void compare_cell(const ComparedCell& run, const ComparedCell& reference) {
    const bool both_ok = run.status == "ok" && reference.status == "ok";
    std::vector<std::string> across;
    if (!may_be_compared(run, reference, !both_ok, across)) return;
    if (!both_ok) {
      compare_status(run, reference);
      return;
    }
    bool same = true;
    for (const ComparedScore& score : reference.scores) {
      same = compare_score(run, find_score(run, score.protocol), score, across) && same;
    }
    for (const ComparedScore& score : run.scores) {
      if (find_score(reference, score.protocol) != nullptr) continue;
      const std::string text = "not in the reference, not compared";
      result_.scores.push_back(
          {run.sequence, run.name, score.protocol, Change::kMoved, {text}, {}, {}, {}});
      add_line(Change::kMoved, result_.scores.back(), text);
    }
    if (same) ++result_.same_cells;
    compare_time(run, reference);
  }

  /// Whether two cells are of the same data and, unless they may differ, of the same parameters.
  /// @param across gets the allowed differences
  bool may_be_compared(const ComparedCell& run, const ComparedCell& reference, bool common_only,
                       std::vector<std::string>& across) {
    std::vector<std::string> wrong;
    bool parameters = true;
    for (const auto& [name, text] :
         fact_differences(run.identity, reference.identity, common_only)) {
      const bool may = is_parameter(name) && options_.across_parameters;
      (may ? across : wrong).push_back(text);
      parameters &= is_parameter(name);
    }
    if (!wrong.empty()) {
      parameters_differ_ |= adding_parameters_ = parameters;
      add_cell_line(Change::kIncomparable, run, reference, join(wrong, "; "));
      adding_parameters_ = false;
      return false;
    }
    const ScoreComparison cell{run.sequence, run.name, "", Change::kMoved, {}, {}, {}, {}};
    if (run.method_version != reference.method_version) {
      const std::string text =
          "method version " + reference.method_version + " -> " + run.method_version;
      if (options_.across_version) across.push_back(text);
      add_line(Change::kMoved, cell, text);
    }
    for (const std::string& text : across) {
      if (is_parameter(text)) add_line(Change::kMoved, cell, text);
    }
    return true;
  }

  void compare_status(const ComparedCell& run, const ComparedCell& reference) {
    const std::string change =
        reference.status + " -> " + run.status +
        (run.reason.empty() || run.status == "ok" ? "" : " (" + run.reason + ")");
    const ComparedCell& scored = reference.scores.empty() ? run : reference;
    if (run.status == "ok") {
      add_cell_line(Change::kBetter, run, scored, change);
    } else if (reference.status == "ok") {
      add_cell_line(Change::kWorse, run, scored, change);
    } else {
      add_cell_line(Change::kMoved, run, scored, "failed in both (" + run.reason + ")");
    }
  }

  /// @return whether nothing moved
  bool compare_score(const ComparedCell& cell, const ComparedScore* run,
                     const ComparedScore& reference, const std::vector<std::string>& across) {
    ScoreComparison score{
        cell.sequence, cell.name, reference.protocol, Change::kSame, {}, across, {}, {}};
    if (run == nullptr) {
      score.reasons.push_back("not scored in the run");
    } else {
      for (const auto& [name, text] : fact_differences(run->identity, reference.identity, false)) {
        score.reasons.push_back(text);
      }
    }
    if (score.reasons.empty()) {
      const std::string changes = compare_scores(cell, *run, reference, options_, score);
      if (!changes.empty()) add_line(score.change, score, changes);
    } else {
      score.change = Change::kIncomparable;
      add_line(score.change, score, join(score.reasons, "; "));
    }
    result_.scores.push_back(std::move(score));
    return result_.scores.back().change == Change::kSame;
  }

  void compare_time(const ComparedCell& run, const ComparedCell& reference) {
    if (run.control || timeless_) return;
    TimeChange time{run.sequence,         run.name,      reference.seconds_per_scan,
                    run.seconds_per_scan, Change::kSame, reference.side_by_side,
                    run.side_by_side};
    const bool both = time.before && time.after && *time.before > 0.0;
    const bool comparable = both && time.has_equal_load();
    if (both && !comparable) load_difference_ = side_by_side_text(time);
    if (!comparable && !options_.time_band) return;
    if (!comparable) {
      time.change = Change::kIncomparable;
    } else if (options_.time_band && time.ratio() > *options_.time_band) {
      time.change = Change::kWorse;
    }
    const std::string text = change_text(time);
    if (comparable) result_.times.push_back(title(run) + ": " + text);
    result_.time_changes.push_back(time);
    if (time.change == Change::kSame) return;
    add_line(time.change, {run.sequence, run.name, "", {}, {}, {}, {}, {}},
             time.change == Change::kWorse
                 ? text + ", more than " + number_text(*options_.time_band) + " times"
                 : text);
  }

  const ComparisonOptions& options_;
  Comparison result_;
  bool timeless_ = false;        ///< The reference has no time at all.
  std::string load_difference_;  ///< Why times of some cells are not compared.
  bool parameters_differ_ =
      false;                   ///< At least one cell is not comparable for its parameters only.
  bool more_differs_ = false;  ///< At least one cell is not comparable for another reason.
  bool adding_parameters_ = false;  ///< The line that is being added is about parameters only.
};

void check_tolerances(const ResultSet& reference, const ComparisonOptions& options) {
  std::set<std::string> known;
  for (const ComparedCell& cell : reference.cells) {
    for (const ComparedScore& score : cell.scores) {
      for (const Rate& rate : score.rates) known.insert(rate.name);
    }
  }
  for (const auto& [name, tolerance] : options.tolerances) {
    if (!known.contains(name)) {
      throw UsageError("--tolerance " + name + ": the reference has no such metric." +
                       suggestion(name, {known.begin(), known.end()}));
    }
    if (!has_known_direction(name)) {
      throw UsageError("--tolerance " + name +
                       ": it is not known which direction of this rate is better, so it decides "
                       "nothing; leave it out.");
    }
  }
}

}  // namespace

const char* change_name(Change change) {
  switch (change) {
    case Change::kSame:
      return "same";
    case Change::kBetter:
      return "better";
    case Change::kMoved:
      return "moved";
    case Change::kWorse:
      return "worse";
    default:
      return "not comparable";
  }
}

ExitCode Comparison::verdict() const {
  if (!incomparable.empty()) return ExitCode::kCannotDo;
  return worse.empty() ? ExitCode::kDone : ExitCode::kWorse;
}

std::string Comparison::verdict_words() const {
  if (verdict() == ExitCode::kCannotDo) return "not comparable";
  if (verdict() == ExitCode::kWorse) return "worse";
  return better.empty() ? "no regression" : "better, no regression";
}

Comparison compare_results(const ResultSet& run, const ResultSet& reference,
                           const ComparisonOptions& options) {
  check_tolerances(reference, options);
  return Comparer(options).compare(run, reference);
}

}  // namespace raymoval
