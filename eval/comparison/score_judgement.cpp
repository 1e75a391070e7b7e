// SPDX-License-Identifier: MIT
#include "eval/comparison/score_judgement.h"

#include <algorithm>
#include <cmath>

#include "core/text.h"
#include "eval/rate.h"

namespace raymoval {
namespace {

/// Rates follow from the counts; more than this is no matter of rounding.
constexpr double kRateNoise = 1e-9;

/// "PR_no_truck" -> "PR": what stands before a protocol's suffix.
bool is_one_of(std::string_view name, const std::vector<std::string_view>& bases) {
  return std::any_of(bases.begin(), bases.end(), [&](std::string_view base) {
    return name == base ||
           (name.starts_with(base) && name.substr(base.size()).starts_with("_no_truck"));
  });
}

/// Counts that follow from scans and labels, so that no mask can change them.
bool is_of_truth(std::string_view count) {
  return is_one_of(count, {"static_voxels", "dynamic_voxels", "mixed_voxels", "static_points",
                           "dynamic_points", "ego_points", "mixed_label_ties", "evaluated_points",
                           "out_of_range_points", "ignored_points", "cropped_points"});
}

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

/// How a score moved, besides what its `ScoreComparison` holds.
struct Movement {
  bool by_rates = false;     ///< Rates are judged, not counts.
  bool rate_rose = false;    ///< A rate of which more is better.
  bool rate_fell = false;    ///< Or is defined on one side only.
  bool beyond = false;       ///< A judged rate fell by more than it may.
  bool truth_moved = false;  ///< A count that no mask can change.
};

/// Whether equal counts are asked for, or rates that may fall so far.
Movement movement_of(const ComparedScore& reference, const ComparisonOptions& options,
                     bool across) {
  Movement movement;
  movement.by_rates = across;
  for (const Rate& rate : reference.rates) {
    movement.by_rates |= options.tolerances.contains(rate.name);
  }
  return movement;
}

/// By how much a rate may fall; nothing if it is not judged. Across parameters all rates are judged
/// where the protocol has no tolerance.
std::optional<double> tolerance_of(const std::string& rate, const ComparedScore& reference,
                                   const ComparisonOptions& options, bool across) {
  const auto given = options.tolerances.find(rate);
  if (given != options.tolerances.end()) return given->second;
  const bool any =
      std::any_of(reference.rates.begin(), reference.rates.end(),
                  [&](const Rate& one) { return options.tolerances.contains(one.name); });
  if (across && !any && higher_is_better(rate)) return 0.0;
  return std::nullopt;
}

/// Judges `rate`, whose values and tolerance are known.
void follow_rate(RateChange& rate, Movement& movement) {
  if (rate.before.has_value() == rate.after.has_value() &&
      (!rate.after || std::abs(*rate.after - *rate.before) <= kRateNoise)) {
    return;
  }
  rate.change = Change::kMoved;
  if (!higher_is_better(rate.name)) return;
  // Defined on one side only: nothing says that it is no worse.
  const bool defined = rate.before && rate.after;
  const bool rose = defined && *rate.after > *rate.before;
  (rose ? movement.rate_rose : movement.rate_fell) = true;
  if (rose) {
    rate.change = Change::kBetter;
  } else if (!rate.tolerance) {
    rate.change = movement.by_rates ? Change::kMoved : Change::kWorse;
  } else if (!defined || *rate.before - *rate.after > *rate.tolerance + kRateNoise) {
    rate.change = Change::kWorse;
    movement.beyond = true;
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

Change judged(const ComparedCell& cell, const Movement& movement) {
  // What a control answers is known beforehand: any change is one of the program.
  if (movement.truth_moved || cell.control) return Change::kWorse;
  if (movement.by_rates ? movement.beyond : movement.rate_fell) return Change::kWorse;
  if (movement.rate_rose && !movement.rate_fell) return Change::kBetter;
  return movement.by_rates ? Change::kMoved : Change::kWorse;
}

}  // namespace

bool higher_is_better(std::string_view rate) {
  const std::string name(rate);
  return is_known_rate(name) && rate_spec(name).higher_is_better;
}

std::string judge_score(const ComparedCell& cell, const ComparedScore& run,
                        const ComparedScore& reference, const ComparisonOptions& options,
                        ScoreComparison& score) {
  const bool across = !score.across.empty();
  Movement movement = movement_of(reference, options, across);
  std::vector<std::string> changes;
  for (const Rate& rate : reference.rates) {
    const Rate* after = find_rate(run.rates, rate.name);
    score.rates.push_back({rate.name, rate.value, after == nullptr ? std::nullopt : after->value,
                           tolerance_of(rate.name, reference, options, across), Change::kSame});
    follow_rate(score.rates.back(), movement);
    if (score.rates.back().change != Change::kSame) {
      changes.push_back(change_text(score.rates.back()));
    }
  }
  score.counts = changed_counts(run, reference);
  for (const CountChange& count : score.counts) {
    movement.truth_moved |= is_of_truth(count.name) || !count.before || !count.after;
    // Across parameters other counts are a matter of course.
    if (!across || movement.truth_moved) changes.push_back(change_text(count));
  }
  if (score.counts.empty() && changes.empty()) return "";
  score.change = judged(cell, movement);
  return changes.empty() ? "counts moved, and no rate with them" : join(changes);
}

}  // namespace raymoval
