// SPDX-License-Identifier: MIT
#include "benchmark/tables/rate_grid.h"

#include <algorithm>

#include "core/text.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

/// @param columns `ColumnRecord` or `MethodColumns`, or null
template <class Columns>
void add_shares(const RateGrid& grid, const Columns* columns, std::vector<TableCell>& cells) {
  for (const std::string& name : grid.shares) {
    const auto percent = columns == nullptr ? std::nullopt : columns->find(name).percent();
    cells.push_back(number_or(percent, 1, "-"));
  }
}

/// The columns of shares and times behind the rates.
void add_headings(const RateGrid& grid, std::vector<std::string>& columns) {
  columns.insert(columns.end(), grid.shares.begin(), grid.shares.end());
  if (grid.timed) columns.emplace_back(kTimeHeading);
}

/// The rates of a method on a sequence, or the status without rates, and its time if the grid has
/// times.
std::vector<TableCell> sequence_cells(const RateGrid& grid, const MethodRates& method,
                                      std::size_t sequence, const TableOptions& options) {
  std::vector<TableCell> cells;
  const std::string& status = method.status[sequence];
  for (const std::string& rate : grid.rates) {
    const auto value = method.values(rate)[sequence];
    cells.push_back(value ? rate_cell(options, rate, *value, method.printed_digits)
                          : TableCell{status.empty() || status == "ok" ? "n/a" : status});
  }
  add_shares(grid, method.columns.empty() ? nullptr : method.columns[sequence], cells);
  if (grid.timed) cells.push_back(number_or(method.ms[sequence], 1, grid.no_time));
  return cells;
}

/// The rates of the grid for which the formula's value at the mean rates is shown too.
std::vector<RateSpec> rates_of_means(const RateGrid& grid) {
  std::vector<RateSpec> specs;
  for (const std::string& rate : grid.rates) {
    const RateSpec spec = rate_spec(rate);
    if (!spec.formula || !spec.formula->shown_of_means) continue;
    if (is_among(grid.rates, spec.formula->first) && is_among(grid.rates, spec.formula->second)) {
      specs.push_back(spec);
    }
  }
  return specs;
}

/// F1 of the mean PR and the mean RR, over the sequences with both.
TableCell of_means_cell(const RateSpec& spec, const MethodRates& method,
                        const TableOptions& options) {
  const RateFormula& formula = *spec.formula;
  const Mean mean =
      combined_means(method.values(formula.first), method.values(formula.second), formula.combine);
  return mean_cell(options, spec.name, mean, method.by_sequence.size(), method.printed_digits);
}

/// The means of a method's rates over the sequences.
std::vector<TableCell> mean_cells(const RateGrid& grid, const MethodRates& method,
                                  const TableOptions& options) {
  std::vector<TableCell> cells;
  for (const std::string& rate : grid.rates) {
    cells.push_back(mean_cell(options, rate, mean_of(method.values(rate)),
                              method.by_sequence.size(), method.printed_digits));
  }
  return cells;
}

std::vector<std::string> mean_names(const RateGrid& grid) {
  std::vector<std::string> names;
  for (const std::string& rate : grid.rates) names.push_back("mean_" + rate);
  return names;
}

/// The content of a column of a table.
struct GridColumn {
  std::string key;  ///< The name for sorting.
  bool higher_is_better = true;
};

/// The columns of a table with a row for each method.
/// @param of_means whether it has columns of `rates_of_means`
std::vector<GridColumn> grid_columns(const RateGrid& grid, bool of_means) {
  std::vector<GridColumn> columns;
  for (const std::string& rate : grid.rates) {
    columns.push_back({rate, rate_spec(rate).higher_is_better});
  }
  if (of_means) {
    for (const RateSpec& spec : rates_of_means(grid)) {
      columns.push_back({spec.name + "_of_means", spec.higher_is_better});
    }
  }
  for (const std::string& share : grid.shares) columns.push_back({share, true});
  if (grid.timed) columns.push_back({kTimeRate, false});
  return columns;
}

/// Sorts the rows of a block, best first; rows without a value come last.
void sort_block(TextTable& table, const RowRange& block, const std::vector<GridColumn>& columns,
                const std::string& by) {
  const auto begin = table.rows.begin() + static_cast<std::ptrdiff_t>(block.first);
  const auto end = table.rows.begin() + static_cast<std::ptrdiff_t>(block.end);
  if (by == "name") {
    std::stable_sort(begin, end, [](const auto& a, const auto& b) { return a.label < b.label; });
    return;
  }
  const auto column = std::find_if(columns.begin(), columns.end(),
                                   [&](const GridColumn& one) { return one.key == by; });
  if (column == columns.end()) return;
  const auto place = static_cast<std::size_t>(column - columns.begin());
  std::stable_sort(begin, end, [&](const TableRow& a, const TableRow& b) {
    const auto left = a.cells[place].value, right = b.cells[place].value;
    if (!left || !right) return left.has_value() && !right;
    return column->higher_is_better ? *left > *right : *left < *right;
  });
}

/// Sorts and marks each block.
void finish_blocks(TextTable& table, const RateGrid& grid, const TableOptions& options,
                   bool of_means) {
  const std::vector<GridColumn> columns = grid_columns(grid, of_means);
  for (const RowRange& block : blocks_of(table)) {
    sort_block(table, block, columns, options.sort);
    if (!grid.ranked) continue;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      mark_best(table, i, columns[i].higher_is_better, block);
    }
  }
}

bool is_complete(const MethodRates& method) {
  return std::all_of(method.by_sequence.begin(), method.by_sequence.end(),
                     [](const auto* known) { return known != nullptr; });
}

TextTable mean_block(const RateGrid& grid, const TableOptions& options) {
  const std::string sequences = std::to_string(grid.sequences.size()) + " sequences";
  TextTable table{grid.title + ", mean over " + sequences, "method", {{"", mean_names(grid)}}};
  const std::vector<RateSpec> of_means = rates_of_means(grid);
  for (const RateSpec& spec : of_means) {
    table.groups[0].columns.push_back(spec.name + "_of_means");
  }
  add_headings(grid, table.groups[0].columns);
  for (const MethodRates& method : grid.methods) {
    if (method.printed_digits > 0 && !is_complete(method)) continue;
    TableRow row = mean_row(grid, method, options);
    auto after_rates = row.cells.begin() + static_cast<std::ptrdiff_t>(grid.rates.size());
    for (const RateSpec& spec : of_means) {
      after_rates = std::next(row.cells.insert(after_rates, of_means_cell(spec, method, options)));
    }
    table.rows.push_back(std::move(row));
  }
  finish_blocks(table, grid, options, true);
  return table;
}

/// The methods in the order of the options, by their means.
std::vector<const MethodRates*> sorted_methods(const RateGrid& grid, const TableOptions& options) {
  std::vector<const MethodRates*> order;
  for (const MethodRates& method : grid.methods) order.push_back(&method);
  const std::string& by = options.sort;
  if (by == "none") return order;
  const auto value_of = [&](const MethodRates& method) -> std::optional<double> {
    if (by == kTimeRate) return method.mean_ms ? std::optional(-*method.mean_ms) : std::nullopt;
    const auto mean = mean_of(method.values(by)).value;
    return mean && !rate_spec(by).higher_is_better ? std::optional(-*mean) : mean;
  };
  std::stable_sort(order.begin(), order.end(), [&](const MethodRates* a, const MethodRates* b) {
    if (by == "name") return a->heading < b->heading;
    const auto left = value_of(*a), right = value_of(*b);
    return left && (!right || *left > *right);
  });
  return order;
}

/// Marks the best methods for each rate of a row with methods side by side.
void mark_row(TableRow& row, const std::vector<std::string>& rates) {
  for (std::size_t place = 0; place < rates.size(); ++place) {
    std::vector<TableCell*> cells;
    for (std::size_t i = place; i < row.cells.size(); i += rates.size()) {
      cells.push_back(&row.cells[i]);
    }
    mark_best(cells, rate_spec(rates[place]).higher_is_better);
  }
}

void add_mean_rows(const RateGrid& grid, const std::vector<const MethodRates*>& methods,
                   const TableOptions& options, TextTable& table) {
  TableRow means{join(mean_names(grid)), {}, true};
  for (const MethodRates* method : methods) {
    for (TableCell& cell : mean_cells(grid, *method, options)) means.cells.push_back(cell);
  }
  table.rows.push_back(std::move(means));
  for (const RateSpec& spec : rates_of_means(grid)) {
    TableRow row{spec.name + "_of_means", {}, true};
    for (const MethodRates* method : methods) {
      for (const std::string& rate : grid.rates) {
        row.cells.push_back(rate == spec.name ? of_means_cell(spec, *method, options)
                                              : TableCell{""});
      }
    }
    table.rows.push_back(std::move(row));
  }
}

/// The paper's Table 2.
TextTable methods_side_by_side(const RateGrid& grid, const TableOptions& options) {
  TextTable table{grid.title, "sequence"};
  const std::vector<const MethodRates*> methods = sorted_methods(grid, options);
  for (const MethodRates* method : methods) table.groups.push_back({method->heading, grid.rates});
  for (std::size_t i = 0; i < grid.sequences.size(); ++i) {
    TableRow& row = table.rows.emplace_back(TableRow{grid.sequences[i], {}});
    for (const MethodRates* method : methods) {
      for (TableCell& cell : sequence_cells(grid, *method, i, options)) row.cells.push_back(cell);
    }
  }
  if (!grid.ranked) return table;
  add_mean_rows(grid, methods, options, table);
  for (TableRow& row : table.rows) mark_row(row, grid.rates);
  return table;
}

}  // namespace

SegmentValues MethodRates::values(const std::string& name) const {
  SegmentValues list;
  for (const std::vector<Rate>* rates : by_sequence) {
    list.push_back(rates == nullptr ? std::nullopt : rate_of(*rates, name));
  }
  return list;
}

MethodRates method_rates(const RunResults& results, const std::string& method,
                         const std::string& protocol) {
  MethodRates row{method};
  for (const std::string& sequence : results.sequences) {
    const Cell* cell = results.find(sequence, method);
    const Score* score = cell == nullptr ? nullptr : cell->score(protocol);
    const bool timed = cell != nullptr && cell->ok() && cell->measured;
    row.by_sequence.push_back(score == nullptr ? nullptr : &score->rates);
    row.status.emplace_back(cell == nullptr ? "" : status_name(cell->status));
    row.columns.push_back(cell != nullptr && cell->columns ? &*cell->columns : nullptr);
    row.ms.push_back(timed ? std::optional(1000.0 * cell->measured->mean_seconds) : std::nullopt);
  }
  row.mean_ms = results.ms_per_scan(method);
  row.all_columns = results.columns_of(method);
  return row;
}

std::vector<std::string> object_shares(const RunResults& results) {
  std::vector<std::string> names;
  for (const char* name : {kParked, kTrails}) {
    const bool there = std::ranges::any_of(
        results.columns, [&](const MethodColumns& method) { return method.find(name).whole > 0; });
    if (there) names.emplace_back(name);
  }
  return names;
}

TextTable sequence_blocks(const RateGrid& grid, const TableOptions& options) {
  TextTable table{grid.title, "method", {{"", grid.rates}}};
  add_headings(grid, table.groups[0].columns);
  for (std::size_t i = 0; i < grid.sequences.size(); ++i) {
    for (const MethodRates& method : grid.methods) {
      // Published rates are shown for their own sequences only.
      if (method.printed_digits > 0 && method.by_sequence[i] == nullptr) continue;
      table.rows.push_back(
          {method.heading, sequence_cells(grid, method, i, options), false, grid.sequences[i]});
    }
  }
  return table;
}

TableRow mean_row(const RateGrid& grid, const MethodRates& method, const TableOptions& options) {
  TableRow row{method.heading, mean_cells(grid, method, options)};
  add_shares(grid, method.all_columns, row.cells);
  if (grid.timed) row.cells.push_back(number_or(method.mean_ms, 1, grid.no_time));
  return row;
}

void sort_blocks(TextTable& table, const RateGrid& grid, const TableOptions& options) {
  for (const RowRange& block : blocks_of(table)) {
    sort_block(table, block, grid_columns(grid, false), options.sort);
  }
}

std::vector<TextTable> rate_tables(const RateGrid& grid, const TableOptions& options) {
  if (options.layout == TableLayout::kSequenceRows) return {methods_side_by_side(grid, options)};
  std::vector<TextTable> tables = {sequence_blocks(grid, options)};
  finish_blocks(tables[0], grid, options, false);
  if (grid.ranked && grid.sequences.size() > 1) tables.push_back(mean_block(grid, options));
  return tables;
}

}  // namespace raymoval
