// SPDX-License-Identifier: MIT
#include <algorithm>

#include "benchmark/tables/rate_grid.h"
#include "benchmark/tables/tables.h"
#include "core/text.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

MethodRates point_rates(const RunResults& results, const SweptCell& point,
                        const std::string& protocol) {
  MethodRates rates = method_rates(results, point.cell, protocol);
  rates.heading = point.point();
  for (std::string& status : rates.status) status = status.empty() ? "not run" : status;
  rates.mean_ms = mean_of(rates.ms).value;
  return rates;
}

/// The rates of a curve. Further means of the two rates add no information.
std::vector<std::string> curve_rates(const RunResults& results, const std::string& protocol,
                                     const TableOptions& options) {
  std::vector<std::string> rates = chosen_rates(options, results, protocol);
  if (options.rates.empty()) {
    std::erase_if(rates, [](const auto& rate) { return rate_spec(rate).role == RateRole::kMean; });
  }
  return rates;
}

/// Marks the best points of each block by the headline rate. The rate of kept or of removed points
/// alone is no criterion.
void mark_curve(const RateGrid& grid, TextTable& table) {
  for (const RowRange& block : blocks_of(table)) {
    for (std::size_t place = 0; place < grid.rates.size(); ++place) {
      const RateSpec spec = rate_spec(grid.rates[place]);
      if (spec.role != RateRole::kHeadline) continue;
      mark_best(table, place, spec.higher_is_better, block);
    }
  }
}

TextTable sweep_table(const RateGrid& grid, const TableOptions& options) {
  TextTable table = sequence_blocks(grid, options);
  table.corner = "parameters";
  if (grid.sequences.size() > 1) {
    for (const MethodRates& point : grid.methods) {
      table.rows.push_back(mean_row(grid, point, options));
      table.rows.back().block = "mean over the sequences";
    }
  }
  sort_blocks(table, grid, options);
  mark_curve(grid, table);
  return table;
}

}  // namespace

std::vector<TextTable> sweep_tables(const RunResults& results, const TableOptions& options) {
  const std::vector<Sweep> sweeps = sweeps_of(results);
  std::vector<TextTable> tables;
  for (const std::string& protocol : results.protocols) {
    for (const Sweep& sweep : sweeps) {
      RateGrid grid;
      grid.title = "Sweep of " + sweep.name + " by protocol " + protocol;
      grid.sequences = results.sequences;
      grid.rates = curve_rates(results, protocol, options);
      grid.timed = options.rates.empty() || shows_time(options);
      grid.no_time = "n/a";
      if (grid.rates.empty()) continue;
      for (const SweptCell* point : sweep.points) {
        grid.methods.push_back(point_rates(results, *point, protocol));
      }
      tables.push_back(sweep_table(grid, options));
      tables.back().notes.emplace_back(
          "Each row is a point of the curve of kept static against removed moving points.");
    }
  }
  return tables;
}

}  // namespace raymoval
