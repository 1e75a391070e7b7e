// SPDX-License-Identifier: MIT
#include "eval/comparison/score_comparison.h"

#include <algorithm>
#include <cmath>

#include "core/text.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

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

}  // namespace

bool has_known_direction(const std::string& rate) {
  return find_rate_spec(rate) != nullptr;
}

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

}  // namespace raymoval
