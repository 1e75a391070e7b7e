// SPDX-License-Identifier: MIT
#include "benchmark/tables/sweep_tables.h"

#include <algorithm>

#include "benchmark/result/flat_sweeps.h"
#include "benchmark/tables/accuracy_tables.h"
#include "core/text.h"
#include "eval/averages.h"
#include "eval/rate.h"

namespace raymoval {
namespace {

/// What a cell of a table shows, or the word for its lack.
TableCell rate_cell(const TableOptions& options, const std::string& rate, const ResultRow* row) {
  if (row == nullptr) return {"not run"};
  if (row->status != "ok") return {row->status};
  const auto found = row->rates.find(rate);
  if (found == row->rates.end() || !found->second) return {"n/a"};
  return {option_text(options, rate, *found->second)};
}

TableCell mean_cell(const TableOptions& options, const std::string& rate,
                    const std::vector<const ResultRow*>& rows) {
  std::vector<std::optional<double>> values;
  for (const ResultRow* row : rows) {
    const bool there = row != nullptr && row->rates.count(rate) > 0;
    values.push_back(there ? row->rates.at(rate) : std::nullopt);
  }
  return {mean_text(options, rate, values)};
}

TableCell time_cell(const std::vector<const ResultRow*>& rows) {
  std::vector<std::optional<double>> values;
  for (const ResultRow* row : rows) {
    values.push_back(row != nullptr ? row->seconds_per_scan : std::nullopt);
  }
  const Mean mean = mean_of(values);
  return {mean.value ? fixed_text(1000.0 * *mean.value, 1) : "n/a"};
}

/// The rows of a point on every sequence, or on one.
std::vector<const ResultRow*> rows_of_point(const RunResults& results, const std::string& cell,
                                            const std::string& protocol) {
  std::vector<const ResultRow*> rows;
  for (const std::string& sequence : results.sequences) {
    rows.push_back(results.find(sequence, cell, protocol));
  }
  return rows;
}

/// A sweep by one protocol.
struct Curve {
  std::string sweep;  ///< SweptCell::sweep().
  std::vector<const SweptCell*> points;
  std::string protocol;
  std::vector<std::string> rates;
  bool timed = true;
};

void add_block(const RunResults& results, const Curve& curve, const TableOptions& options,
               std::optional<std::size_t> sequence, TextTable& table) {
  for (const SweptCell* point : curve.points) {
    std::vector<const ResultRow*> rows = rows_of_point(results, point->cell, curve.protocol);
    TableRow row{point->point(),
                 {},
                 false,
                 sequence ? results.sequences[*sequence] : "mean over the sequences"};
    if (sequence) rows = {rows[*sequence]};
    for (const std::string& rate : curve.rates) {
      row.cells.push_back(sequence ? rate_cell(options, rate, rows.front())
                                   : mean_cell(options, rate, rows));
    }
    if (curve.timed) row.cells.push_back(time_cell(rows));
    table.rows.push_back(std::move(row));
  }
}

/// Marks the best points of each block by the rates that are both in one: alone, what is kept or
/// what is removed decides nothing.
void mark_curve(const Curve& curve, TextTable& table) {
  for (const RowRange& block : blocks_of(table)) {
    for (std::size_t place = 0; place < curve.rates.size(); ++place) {
      const RateSpec spec = rate_spec(curve.rates[place]);
      if (spec.role != RateRole::kHeadline) continue;
      std::vector<TableCell*> cells;
      for (std::size_t i = block.first; i < block.end; ++i) {
        cells.push_back(&table.rows[i].cells[place]);
      }
      mark_best(cells, spec.higher_is_better);
    }
  }
}

TextTable sweep_table(const RunResults& results, const Curve& curve, const TableOptions& options) {
  TextTable table{"Sweep of " + curve.sweep + " by protocol " + curve.protocol,
                  "parameters",
                  {{"", curve.rates}},
                  {},
                  {}};
  if (curve.timed) table.groups[0].columns.emplace_back("ms per scan");
  for (std::size_t i = 0; i < results.sequences.size(); ++i) {
    add_block(results, curve, options, i, table);
  }
  if (results.sequences.size() > 1) add_block(results, curve, options, std::nullopt, table);
  mark_curve(curve, table);
  table.notes.push_back(
      "Each row is a point of the curve of what is kept against what is removed.");
  for (const std::string& line : flat_sweeps(results, curve.sweep)) table.notes.push_back(line);
  return table;
}

}  // namespace

std::vector<TextTable> sweep_tables(const RunResults& results, const TableOptions& options) {
  std::vector<Curve> curves;
  for (const SweptCell& point : results.sweeps) {
    const auto known = std::find_if(curves.begin(), curves.end(), [&](const Curve& curve) {
      return curve.sweep == point.sweep();
    });
    if (known == curves.end()) {
      curves.push_back(
          {point.sweep(), {&point}, "", {}, options.rates.empty() || shows_time(options)});
    } else {
      known->points.push_back(&point);
    }
  }
  std::vector<TextTable> tables;
  for (const std::string& protocol : results.protocols) {
    for (Curve& curve : curves) {
      curve.protocol = protocol;
      curve.rates = chosen_rates(options, results, protocol);
      // The other mean of the two rates says nothing more of a curve.
      if (options.rates.empty()) {
        std::erase_if(curve.rates, [](const std::string& rate) {
          return rate_spec(rate).role == RateRole::kMean;
        });
      }
      if (!curve.rates.empty()) tables.push_back(sweep_table(results, curve, options));
    }
  }
  return tables;
}

}  // namespace raymoval
