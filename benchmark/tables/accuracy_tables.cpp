// SPDX-License-Identifier: MIT
#include "benchmark/tables/accuracy_tables.h"

#include <algorithm>

#include "benchmark/tables/rate_grid.h"
#include "core/text.h"
#include "eval/rate.h"

namespace raymoval {
namespace {

constexpr const char* kErasor = "erasor";
constexpr const char* kDynamicmap = "dynamicmap";

bool among(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<MethodRates> run_methods(const RunResults& results, const std::string& protocol,
                                     bool controls) {
  std::vector<MethodRates> methods;
  for (const std::string& cell : results.cells) {
    if (results.is_swept(cell)) continue;  // Shown in a table of its own.
    MethodRates method{cell};
    bool wanted = false;
    for (const std::string& sequence : results.sequences) {
      const ResultRow* row = results.find(sequence, cell, protocol);
      const bool scored = row != nullptr && row->status == "ok";
      method.by_sequence.push_back(scored ? &row->rates : nullptr);
      method.status.push_back(row != nullptr ? row->status : "");
      const bool timed = scored && row->seconds_per_scan;
      method.ms.push_back(timed ? std::optional(1000.0 * *row->seconds_per_scan) : std::nullopt);
      if (row != nullptr && row->control == controls) wanted = true;
    }
    method.mean_ms = results.ms_per_scan(cell);
    if (wanted) methods.push_back(std::move(method));
  }
  return methods;
}

MethodRates outside_rates(const std::vector<std::string>& sequences, const OutsideColumn& given) {
  MethodRates method{given.heading};
  method.printed_digits = given.protocol == kErasor ? 3 : 2;
  for (const std::string& sequence : sequences) {
    method.by_sequence.push_back(given.find(sequence));
    method.status.emplace_back("-");
    method.ms.emplace_back(std::nullopt);
  }
  return method;
}

/// Whether published numbers are of the protocol that a run calls `protocol`. The strict variant of
/// dynamicmap has the same rates by other rules.
bool is_of(const OutsideColumn& given, const std::string& protocol, const RunResults& results) {
  if (given.protocol != kErasor) return given.protocol == protocol;
  const std::vector<std::string> rates = results.rates_of(protocol);
  return among(rates, "PR") && among(rates, "RR");
}

bool shares_sequence(const OutsideColumn& given, const RunResults& results) {
  return std::any_of(results.sequences.begin(), results.sequences.end(),
                     [&](const std::string& name) { return given.find(name) != nullptr; });
}

std::string rate_words(const RateGrid& grid, const TableOptions& options) {
  std::vector<std::string> fractions;
  for (const std::string& rate : grid.rates) {
    if (rate_spec(rate).unit == RateUnit::kFraction) fractions.push_back(rate);
  }
  std::string text = "Rates in percent";
  if (!fractions.empty()) text += ", " + join(fractions, " and ") + " as a fraction";
  text += ".";
  if (among(grid.rates, "AA")) {
    text += " AA is the geometric and HA the harmonic mean of SA and DA.";
  }
  const bool averages = grid.sequences.size() > 1 || options.layout == TableLayout::kSequenceRows;
  if (averages && among(grid.rates, "F1")) {
    text += " mean_F1 is the mean of the F1 values; F1_of_means is the F1 of mean PR and mean RR.";
  }
  text += " n/a: undefined or not run";
  if (averages) text += "; (4/5): the mean is over the 4 of 5 sequences that have a value";
  return text + ".";
}

/// All published numbers of a protocol. Those of dynamicmap are on different kinds of data, over
/// which no mean is taken.
std::vector<TextTable> published_of(const std::vector<OutsideColumn>& outside,
                                    const std::string& protocol, const TableOptions& options) {
  RateGrid grid;
  const bool erasor = protocol == kErasor;
  grid.title = erasor ? "Published" : "Published, DynamicMap benchmark";
  grid.ranked = erasor;
  grid.rates = erasor ? std::vector<std::string>{"PR", "RR", "F1"}
                      : std::vector<std::string>{"SA", "DA", "AA", "HA"};
  if (!options.rates.empty()) {
    std::erase_if(grid.rates, [&](const auto& rate) { return !among(options.rates, rate); });
  }
  for (const OutsideColumn& given : outside) {
    for (const auto& [name, rates] : given.sequences) {
      if (given.protocol == protocol && !among(grid.sequences, name))
        grid.sequences.push_back(name);
    }
  }
  for (const OutsideColumn& given : outside) {
    if (given.protocol == protocol) grid.methods.push_back(outside_rates(grid.sequences, given));
  }
  if (grid.rates.empty()) return {};
  std::vector<TextTable> tables = rate_tables(grid, options);
  tables.back().notes.push_back(
      erasor ? "Values as printed (Raymoval paper, Table 2); the means are computed from them, "
               "since two of the printed means are misprints."
             : "As printed by the benchmark, DUFOMap and BeautyMap, to 2 decimals; -: not printed. "
               "KITTI at every frame, without a range limit; which frames lie behind 01 is not "
               "known. More in results/published/.");
  return tables;
}

}  // namespace

std::vector<TextTable> accuracy_tables(const RunResults& results, const std::string& protocol,
                                       const TableOptions& options) {
  RateGrid grid;
  grid.title = "Accuracy by protocol " + protocol;
  grid.sequences = results.sequences;
  grid.methods = run_methods(results, protocol, false);
  grid.rates = chosen_rates(options, results, protocol);
  grid.timed = shows_time(options) && options.layout == TableLayout::kMethodRows;
  for (const OutsideColumn& given : options.outside) {
    if (!is_of(given, protocol, results) || !shares_sequence(given, results)) continue;
    grid.methods.push_back(outside_rates(results.sequences, given));
  }
  if (grid.methods.empty() || (grid.rates.empty() && !results.rates_of(protocol).empty()))
    return {};
  std::vector<TextTable> tables = rate_tables(grid, options);
  tables.back().notes.push_back(rate_words(grid, options));
  return tables;
}

std::vector<TextTable> control_tables(const RunResults& results, const std::string& protocol,
                                      const TableOptions& options) {
  RateGrid grid;
  grid.title = "Controls by protocol " + protocol;
  grid.sequences = results.sequences;
  grid.methods = run_methods(results, protocol, true);
  grid.rates = chosen_rates(options, results, protocol);
  grid.ranked = false;
  if (grid.methods.empty() || (grid.rates.empty() && !results.rates_of(protocol).empty()))
    return {};
  std::vector<TextTable> tables = rate_tables(grid, options);
  tables.back().notes.push_back(controls_text(results));
  return tables;
}

std::vector<TextTable> published_tables(const RunResults& results, const TableOptions& options) {
  std::vector<TextTable> tables;
  for (const char* published : {kErasor, kDynamicmap}) {
    const bool wanted =
        std::any_of(options.outside.begin(), options.outside.end(), [&](const auto& given) {
          return given.protocol == published && shares_sequence(given, results) &&
                 std::any_of(
                     results.protocols.begin(), results.protocols.end(),
                     [&](const std::string& protocol) { return is_of(given, protocol, results); });
        });
    if (!wanted) continue;
    for (TextTable& table : published_of(options.outside, published, options)) {
      tables.push_back(std::move(table));
    }
  }
  return tables;
}

std::vector<std::string> unpublished_sequences(const RunResults& results,
                                               const std::vector<OutsideColumn>& outside) {
  std::vector<std::string> names;
  for (const std::string& name : results.sequences) {
    const bool known = std::any_of(outside.begin(), outside.end(), [&](const auto& given) {
      return given.find(name) != nullptr &&
             std::any_of(results.protocols.begin(), results.protocols.end(),
                         [&](const auto& protocol) { return is_of(given, protocol, results); });
    });
    if (!known) names.push_back(name);
  }
  return names;
}

std::string controls_text(const RunResults& results) {
  return results.control_problems.empty()
             ? "All controls are as they must be."
             : "CONTROLS ARE OFF: " + join(results.control_problems, "; ") + ".";
}

}  // namespace raymoval
