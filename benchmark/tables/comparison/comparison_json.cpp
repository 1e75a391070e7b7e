// SPDX-License-Identifier: MIT
#include "benchmark/tables/comparison/comparison_json.h"

#include <nlohmann/json.hpp>
#include <optional>

#include "benchmark/result/cell.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;

template <class Value>
ordered_json value_or_null(const std::optional<Value>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

/// A list with what `to_record` makes of each item.
template <class Item, class Function>
ordered_json list_of(const std::vector<Item>& items, Function to_record) {
  ordered_json list = ordered_json::array();
  for (const Item& item : items) list.push_back(to_record(item));
  return list;
}

ordered_json options_record(const ComparisonOptions& options) {
  ordered_json tolerances = ordered_json::object();
  for (const auto& [rate, tolerance] : options.tolerances) tolerances[rate] = tolerance;
  ordered_json across = ordered_json::array();
  if (options.across_parameters) across.push_back("parameters");
  if (options.across_version) across.push_back("version");
  return {{"tolerances", std::move(tolerances)},
          {"time_band", value_or_null(options.time_band)},
          {"across", std::move(across)}};
}

ordered_json rate_record(const RateChange& rate) {
  return {{"name", rate.name},
          {"reference", value_or_null(rate.before)},
          {"run", value_or_null(rate.after)},
          {"tolerance", value_or_null(rate.tolerance)},
          {"verdict", change_name(rate.change)}};
}

ordered_json count_record(const CountChange& count) {
  return {{"name", count.name},
          {"reference", value_or_null(count.before)},
          {"run", value_or_null(count.after)}};
}

ordered_json score_record(const ScoreComparison& score) {
  return {
      {"sequence", score.sequence},
      {"name", score.name},
      {"protocol", score.protocol.empty() ? ordered_json(nullptr) : ordered_json(score.protocol)},
      {"verdict", change_name(score.change)},
      {"reasons", score.reasons},
      {"across", score.across},
      {"rates", list_of(score.rates, rate_record)},
      {"counts", list_of(score.counts, count_record)}};
}

ordered_json time_record(const TimeChange& time) {
  const bool both = time.change != Change::kIncomparable;
  return {{"sequence", time.sequence},
          {"name", time.name},
          {"reference", value_or_null(time.before)},
          {"run", value_or_null(time.after)},
          {"ratio", both ? ordered_json(time.ratio()) : ordered_json(nullptr)},
          {"verdict", change_name(time.change)}};
}

/// The lines that are about the run as a whole.
ordered_json problem_records(const Comparison& comparison) {
  ordered_json problems = ordered_json::array();
  for (const ComparisonLine& line : comparison.lines) {
    if (!line.sequence.empty()) continue;
    problems.push_back({{"verdict", change_name(line.change)}, {"text", line.text}});
  }
  return problems;
}

}  // namespace

ordered_json to_json(const Comparison& comparison, const ComparisonSubject& subject) {
  return {{"schema_version", kSchemaVersion},
          {"run", subject.run},
          {"reference", subject.reference},
          {"verdict", comparison.verdict_words()},
          {"exit_code", static_cast<int>(comparison.verdict())},
          {"cells", comparison.cells},
          {"same_cells", comparison.same_cells},
          {"options", options_record(subject.options)},
          {"problems", problem_records(comparison)},
          {"scores", list_of(comparison.scores, score_record)},
          {"times", list_of(comparison.time_changes, time_record)}};
}

}  // namespace raymoval
