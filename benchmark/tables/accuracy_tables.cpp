// SPDX-License-Identifier: MIT
// The rates of methods and controls of a run, and those of papers.
#include <algorithm>

#include "benchmark/tables/rate_grid.h"
#include "benchmark/tables/tables.h"
#include "core/text.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

std::vector<MethodRates> run_methods(const RunResults& results, const std::string& protocol,
                                     bool controls) {
  std::vector<MethodRates> methods;
  for (const std::string& method : results.methods) {
    if (results.is_swept(method)) continue;  // Shown in a table of its own.
    const bool wanted = std::ranges::any_of(results.cells, [&](const Cell& cell) {
      return cell.name == method && cell.method.control == controls;
    });
    if (wanted) methods.push_back(method_rates(results, method, protocol));
  }
  return methods;
}

MethodRates outside_rates(const std::vector<std::string>& sequences, const OutsideColumn& given,
                          std::string OutsideRow::*which) {
  MethodRates method{given.heading};
  method.printed_digits = published_form(given.protocol).decimals;
  for (const std::string& sequence : sequences) {
    method.by_sequence.push_back(given.find(which, sequence));
  }
  method.status.assign(sequences.size(), "-");
  method.ms.resize(sequences.size());
  return method;
}

/// Whether `given` has rates for a sequence of the run.
bool shares_sequence(const OutsideColumn& given, const RunResults& results) {
  return std::ranges::any_of(results.sequences,
                             [&](const std::string& name) {
                               return given.find(&OutsideRow::beside, name) != nullptr;
                             }) &&
         std::ranges::any_of(results.protocols, [&](const std::string& name) {
           return results.kind_of(name) == given.protocol;
         });
}

/// The note below a table that explains its rates.
std::string rate_words(const RateGrid& grid, const TableOptions& options) {
  std::string text = rate_units_text(grid.rates);
  const bool averages = grid.sequences.size() > 1 || options.layout == TableLayout::kSequenceRows;
  for (const std::string& rate : grid.rates) {
    const RateSpec spec = rate_spec(rate);
    if (!spec.note.empty()) text += " " + spec.note;
    if (!averages || !spec.formula || !spec.formula->shown_of_means) continue;
    text += " mean_" + rate + " is the mean of the " + rate + " values; " + rate +
            "_of_means is the " + rate + " of mean " + spec.formula->first + " and mean " +
            spec.formula->second + ".";
  }
  if (!grid.shares.empty()) text += " " + std::string(kObjectWords);
  text += " n/a: undefined or not run";
  if (averages) text += "; (4/5): the mean is over the 4 of 5 sequences that have a value";
  return text + ".";
}

/// All published numbers of a protocol.
std::vector<TextTable> published_of(const std::string& protocol, const TableOptions& options) {
  const PublishedForm& form = published_form(protocol);
  RateGrid grid;
  grid.title = form.title;
  grid.ranked = form.comparable;
  for (const RateSpec& spec : protocol_entry(protocol).rates) {
    if (spec.role == RateRole::kSecondary) continue;  // Papers print none.
    if (options.rates.empty() || is_among(options.rates, spec.name)) {
      grid.rates.push_back(spec.name);
    }
  }
  if (grid.rates.empty()) return {};
  for (const OutsideColumn& given : options.outside) {
    if (given.protocol != protocol) continue;
    for (const OutsideRow& row : given.rows) add_once(grid.sequences, row.sequence);
  }
  for (const OutsideColumn& given : options.outside) {
    if (given.protocol != protocol) continue;
    grid.methods.push_back(outside_rates(grid.sequences, given, &OutsideRow::sequence));
  }
  std::vector<TextTable> tables = rate_tables(grid, options);
  tables.back().notes.emplace_back(form.note);
  return tables;
}

/// The rates of the run's methods, or of its controls.
RateGrid run_grid(const RunResults& results, const std::string& protocol,
                  const TableOptions& options, bool controls) {
  RateGrid grid;
  grid.title = (controls ? "Controls by protocol " : "Accuracy by protocol ") + protocol;
  grid.sequences = results.sequences;
  grid.methods = run_methods(results, protocol, controls);
  grid.rates = chosen_rates(options, results, protocol);
  grid.ranked = !controls;
  return grid;
}

std::vector<TextTable> run_tables(const RateGrid& grid, const RunResults& results,
                                  const std::string& protocol, const TableOptions& options,
                                  const std::string& note) {
  const bool none_chosen = grid.rates.empty() && !results.rates_of(protocol).empty();
  if (grid.methods.empty() || none_chosen) return {};
  std::vector<TextTable> tables = rate_tables(grid, options);
  tables.back().notes.push_back(note);
  return tables;
}

}  // namespace

std::vector<TextTable> accuracy_tables(const RunResults& results, const std::string& protocol,
                                       const TableOptions& options) {
  RateGrid grid = run_grid(results, protocol, options, false);
  const bool by_method = options.layout == TableLayout::kMethodRows;
  if (by_method && options.rates.empty()) grid.shares = object_shares(results);
  grid.timed = shows_time(options) && by_method;
  for (const OutsideColumn& given : options.outside) {
    if (given.protocol != results.kind_of(protocol) || !shares_sequence(given, results)) continue;
    grid.methods.push_back(outside_rates(results.sequences, given, &OutsideRow::beside));
  }
  return run_tables(grid, results, protocol, options, rate_words(grid, options));
}

std::vector<TextTable> control_tables(const RunResults& results, const std::string& protocol,
                                      const TableOptions& options) {
  return run_tables(run_grid(results, protocol, options, true), results, protocol, options,
                    controls_text(results));
}

std::vector<TextTable> published_tables(const RunResults& results, const TableOptions& options) {
  std::vector<TextTable> tables;
  for (const ProtocolEntry& entry : protocol_entries()) {
    const bool wanted = std::any_of(
        options.outside.begin(), options.outside.end(), [&](const OutsideColumn& given) {
          return given.protocol == entry.name && shares_sequence(given, results);
        });
    if (!wanted) continue;
    for (TextTable& table : published_of(entry.name, options)) tables.push_back(std::move(table));
  }
  return tables;
}

std::string controls_text(const RunResults& results) {
  return results.control_problems.empty()
             ? "All controls have their expected scores."
             : "CONTROLS ARE OFF: " + join(results.control_problems, "; ") + ".";
}

}  // namespace raymoval
