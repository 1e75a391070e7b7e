// SPDX-License-Identifier: MIT
#include "eval/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>

#include "core/text.h"

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

bool higher_is_better(std::string_view rate) {
  return is_one_of(rate, {"PR", "RR", "F1", "SA", "DA", "AA", "HA"});
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

const ComparedCell* find_cell(const ResultSet& set, const ComparedCell& wanted) {
  for (const ComparedCell& cell : set.cells) {
    if (cell.sequence == wanted.sequence && cell.name == wanted.name) return &cell;
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

std::string rate_words(const std::optional<double>& value) {
  return value ? fixed_text(*value, 4) : "undefined";
}

/// "F1 0.9368 -> 0.9400 (+0.0032)".
std::string rate_change(const std::string& name, const std::optional<double>& before,
                        const std::optional<double>& after) {
  std::string text = name + " " + rate_words(before) + " -> " + rate_words(after);
  if (!before || !after) return text;
  const double change = *after - *before;
  return text + " (" + (change > 0 ? "+" : "") + fixed_text(change, 4) + ")";
}

std::string count_change(const std::string& name, std::int64_t before, std::int64_t after) {
  const std::int64_t change = after - before;
  return name + " " + std::to_string(before) + " -> " + std::to_string(after) + " (" +
         (change > 0 ? "+" : "") + std::to_string(change) + ")";
}

/// What of `run` and `reference` differs; with `common_only`, facts that one lacks are passed over.
std::vector<std::string> fact_differences(const Facts& run, const Facts& reference,
                                          bool common_only) {
  std::vector<std::string> differences;
  for (const auto& [name, value] : reference) {
    const auto found = run.find(name);
    if (found == run.end()) {
      if (!common_only) differences.push_back(name + " is missing, the reference has " + value);
    } else if (found->second != value) {
      differences.push_back(name + " is " + found->second + ", the reference has " + value);
    }
  }
  for (const auto& [name, value] : run) {
    if (!common_only && !reference.contains(name)) {
      differences.push_back(name + " is " + value + ", the reference has none");
    }
  }
  return differences;
}

/// How a score moved.
struct Movement {
  std::vector<std::string> changes;
  bool rate_rose = false;
  bool rate_fell = false;     ///< Or changed where no direction is the better one.
  bool beyond = false;        ///< A rate with a tolerance fell by more than it.
  bool counts_moved = false;  ///< Any count.
  bool truth_moved = false;   ///< A count that no mask can change.
  bool tolerant = false;      ///< Some rate of this protocol has a tolerance.
};

void follow_rate(const Rate& before, const std::optional<double>& after,
                 const ComparisonOptions& options, Movement& movement) {
  const auto tolerance = options.tolerances.find(before.name);
  const bool judged = tolerance != options.tolerances.end();
  movement.tolerant |= judged;
  if (before.value.has_value() == after.has_value() &&
      (!after || std::abs(*after - *before.value) <= kRateNoise)) {
    return;
  }
  movement.changes.push_back(rate_change(before.name, before.value, after));
  if (!before.value || !after) {  // Defined on one side only: nothing says that it is no worse.
    movement.rate_fell = true;
    movement.beyond |= judged;
    return;
  }
  const bool rose = *after > *before.value && higher_is_better(before.name);
  (rose ? movement.rate_rose : movement.rate_fell) = true;
  if (judged && !rose) {
    movement.beyond |= std::abs(*after - *before.value) > tolerance->second + kRateNoise;
  }
}

void follow_counts(const ComparedScore& run, const ComparedScore& reference, Movement& movement) {
  for (const auto& [name, before] : reference.counts) {
    const std::int64_t* after = find_value(run.counts, name);
    if (after != nullptr && *after == before) continue;
    movement.counts_moved = true;
    movement.truth_moved |= is_of_truth(name) || after == nullptr;
    movement.changes.push_back(after == nullptr ? "count " + name + " is missing"
                                                : count_change(name, before, *after));
  }
  for (const auto& [name, after] : run.counts) {
    if (find_value(reference.counts, name) != nullptr) continue;
    movement.counts_moved = movement.truth_moved = true;
    movement.changes.push_back("count " + name + " is new");
  }
}

/// Compares cell after cell and collects what it finds.
class Comparer {
 public:
  explicit Comparer(const ComparisonOptions& options) : options_(options) {}

  Comparison compare(const ResultSet& run, const ResultSet& reference) {
    result_.cells = reference.cells.size();
    if (reference.cells.empty()) result_.incomparable.push_back("the reference has no cell");
    for (const std::string& problem : reference.control_problems) {
      result_.incomparable.push_back("the reference is unsound: " + problem);
    }
    result_.worse = run.control_problems;
    for (const ComparedCell& cell : reference.cells) {
      const ComparedCell* found = find_cell(run, cell);
      if (found == nullptr) {
        result_.incomparable.push_back(title(cell) + ": missing in the run");
      } else {
        compare_cell(*found, cell);
      }
    }
    for (const ComparedCell& cell : run.cells) {
      if (find_cell(reference, cell) != nullptr) continue;
      result_.moved.push_back(title(cell) + ": not in the reference, not compared");
    }
    return std::move(result_);
  }

 private:
  void compare_cell(const ComparedCell& run, const ComparedCell& reference) {
    const bool run_failed = run.status != "ok";
    const bool both_ok = !run_failed && reference.status == "ok";
    const auto differences = fact_differences(run.identity, reference.identity, !both_ok);
    for (const std::string& difference : differences) {
      result_.incomparable.push_back(title(run) + ": " + difference);
    }
    if (!differences.empty()) return;
    if (run.method_version != reference.method_version) {
      result_.moved.push_back(title(run) + ": method version " + reference.method_version + " -> " +
                              run.method_version);
    }
    if (!both_ok) {
      compare_status(run, reference);
      return;
    }
    bool same = true;
    for (const ComparedScore& score : reference.scores) {
      same = compare_score(run, find_score(run, score.protocol), score) && same;
    }
    for (const ComparedScore& score : run.scores) {
      if (find_score(reference, score.protocol) != nullptr) continue;
      result_.moved.push_back(title(run) + ", " + score.protocol +
                              ": not in the reference, not compared");
    }
    if (same) ++result_.same_cells;
    compare_time(run, reference);
  }

  void compare_status(const ComparedCell& run, const ComparedCell& reference) {
    const std::string change =
        title(run) + ": " + reference.status + " -> " + run.status +
        (run.reason.empty() || run.status == "ok" ? "" : " (" + run.reason + ")");
    if (run.status == "ok") {
      result_.better.push_back(change);
    } else if (reference.status == "ok") {
      result_.worse.push_back(change);
    } else {
      result_.moved.push_back(title(run) + ": failed in both (" + run.reason + ")");
    }
  }

  /// @return whether nothing moved
  bool compare_score(const ComparedCell& cell, const ComparedScore* run,
                     const ComparedScore& reference) {
    const std::string where = title(cell) + ", " + reference.protocol + ": ";
    if (run == nullptr) {
      result_.incomparable.push_back(where + "not scored in the run");
      return false;
    }
    const auto differences = fact_differences(run->identity, reference.identity, false);
    for (const std::string& difference : differences) {
      result_.incomparable.push_back(where + difference);
    }
    if (!differences.empty()) return false;
    Movement movement;
    for (const Rate& rate : reference.rates) {
      const Rate* after = find_rate(run->rates, rate.name);
      follow_rate(rate, after == nullptr ? std::nullopt : after->value, options_, movement);
    }
    follow_counts(*run, reference, movement);
    if (movement.changes.empty()) return true;
    list_for(cell, movement).push_back(where + join(movement.changes));
    return false;
  }

  std::vector<std::string>& list_for(const ComparedCell& cell, const Movement& movement) {
    // What a control answers is known beforehand: any change is one of the program.
    if (movement.truth_moved || cell.control) return result_.worse;
    if (movement.tolerant ? movement.beyond : movement.rate_fell) return result_.worse;
    if (movement.rate_rose && !movement.rate_fell) return result_.better;
    return movement.tolerant ? result_.moved : result_.worse;
  }

  void compare_time(const ComparedCell& run, const ComparedCell& reference) {
    if (run.control) return;
    if (!run.seconds_per_scan || !reference.seconds_per_scan ||
        !(*reference.seconds_per_scan > 0.0)) {
      if (options_.time_band) {
        result_.incomparable.push_back(title(run) +
                                       ": no time on both sides; leave --time-band out");
      }
      return;
    }
    const double ratio = *run.seconds_per_scan / *reference.seconds_per_scan;
    const std::string told = title(run) + ": " + fixed_text(ratio, 2) + " times the reference (" +
                             fixed_text(*run.seconds_per_scan * 1e3, 1) + " ms per scan, was " +
                             fixed_text(*reference.seconds_per_scan * 1e3, 1) + ")";
    result_.times.push_back(told);
    if (options_.time_band && ratio > *options_.time_band) {
      result_.worse.push_back(told + ", more than " + number_text(*options_.time_band) + " times");
    }
  }

  const ComparisonOptions& options_;
  Comparison result_;
};

void check_tolerances(const ResultSet& reference, const ComparisonOptions& options) {
  std::set<std::string> known;
  for (const ComparedCell& cell : reference.cells) {
    for (const ComparedScore& score : cell.scores) {
      for (const Rate& rate : score.rates) known.insert(rate.name);
    }
  }
  for (const auto& [name, tolerance] : options.tolerances) {
    if (known.contains(name)) continue;
    throw UsageError("--tolerance " + name + ": the reference has no such metric." +
                     suggestion(name, {known.begin(), known.end()}));
  }
}

}  // namespace

ExitCode Comparison::verdict() const {
  if (!incomparable.empty()) return ExitCode::kCannotDo;
  return worse.empty() ? ExitCode::kDone : ExitCode::kWorse;
}

Comparison compare_results(const ResultSet& run, const ResultSet& reference,
                           const ComparisonOptions& options) {
  check_tolerances(reference, options);
  return Comparer(options).compare(run, reference);
}

std::string comparison_text(const Comparison& comparison) {
  const std::array<std::pair<const char*, const std::vector<std::string>*>, 5> parts = {{
      {"Not comparable", &comparison.incomparable},
      {"Worse", &comparison.worse},
      {"Better", &comparison.better},
      {"Moved or new", &comparison.moved},
      {"Time", &comparison.times},
  }};
  std::string text;
  for (const auto& [heading, lines] : parts) {
    if (lines->empty()) continue;
    text += std::string(heading) + ":\n";
    for (const std::string& line : *lines) text += "  " + line + "\n";
  }
  text += std::to_string(comparison.same_cells) + " of " + std::to_string(comparison.cells) +
          " cells are the same as in the reference: ";
  switch (comparison.verdict()) {
    case ExitCode::kCannotDo:
      return text + "not comparable.\n";
    case ExitCode::kWorse:
      return text + "worse.\n";
    default:
      return text + (comparison.better.empty() ? "no regression.\n" : "better, no regression.\n");
  }
}

}  // namespace raymoval
