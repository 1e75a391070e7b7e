// SPDX-License-Identifier: MIT
#include "benchmark/tables/rate_grid.h"

#include <algorithm>

#include "benchmark/tables/accuracy_tables.h"
#include "core/text.h"
#include "eval/averages.h"
#include "eval/rate.h"

namespace raymoval {
namespace {

constexpr const char* kTimeHeading = "ms per scan";
constexpr const char* kF1OfMeans = "F1_of_means";

std::string time_cell_text(const std::optional<double>& ms) {
  return ms ? fixed_text(*ms, 1) : "-";
}

/// The text of a rate, or the word for its lack.
std::string rate_cell_text(const MethodRates& method, std::size_t sequence, const std::string& rate,
                           const TableOptions& options) {
  const auto value = method.rate(sequence, rate);
  if (value) return option_text(options, rate, *value, method.printed_digits);
  const std::string& status = method.status[sequence];
  return status.empty() || status == "ok" ? "n/a" : status;
}

bool has_f1_of_means(const RateGrid& grid) {
  const auto has = [&](const char* rate) {
    return std::find(grid.rates.begin(), grid.rates.end(), rate) != grid.rates.end();
  };
  return has("PR") && has("RR") && has("F1");
}

std::vector<std::string> mean_names(const RateGrid& grid) {
  std::vector<std::string> names;
  for (const std::string& rate : grid.rates) names.push_back("mean_" + rate);
  return names;
}

/// Marks the cells of each column within a block.
void mark_columns(TextTable& table, const RowRange& block, const RateGrid& grid) {
  const std::size_t columns = table.rows[block.first].cells.size();
  for (std::size_t place = 0; place < columns; ++place) {
    std::vector<TableCell*> cells;
    for (std::size_t i = block.first; i < block.end; ++i) {
      cells.push_back(&table.rows[i].cells[place]);
    }
    const bool is_rate = place < grid.rates.size();
    const bool is_time = grid.timed && place + 1 == columns;
    mark_best(cells, is_rate ? rate_spec(grid.rates[place]).higher_is_better : !is_time);
  }
}

/// Sorts the rows of a block, best first; those without a value come last.
/// @param keys of each column, by which a user may sort
void sort_block(TextTable& table, const RowRange& block, const std::vector<std::string>& keys,
                const std::string& by) {
  const auto begin = table.rows.begin() + static_cast<std::ptrdiff_t>(block.first);
  const auto end = table.rows.begin() + static_cast<std::ptrdiff_t>(block.end);
  if (by == "name") {
    std::stable_sort(begin, end, [](const auto& a, const auto& b) { return a.label < b.label; });
    return;
  }
  const auto place =
      static_cast<std::size_t>(std::find(keys.begin(), keys.end(), by) - keys.begin());
  if (place == keys.size()) return;
  const bool higher = by != kTimeRate && rate_spec(by).higher_is_better;
  std::stable_sort(begin, end, [&](const TableRow& a, const TableRow& b) {
    const auto left = leading_number(a.cells[place].text);
    const auto right = leading_number(b.cells[place].text);
    if (!left || !right) return left.has_value() && !right;
    return higher ? *left > *right : *left < *right;
  });
}

/// Sorts and marks each block.
void finish_blocks(TextTable& table, const RateGrid& grid, const TableOptions& options) {
  std::vector<std::string> keys = grid.rates;
  if (table.groups.front().columns.size() > grid.rates.size() + (grid.timed ? 1 : 0)) {
    keys.emplace_back(kF1OfMeans);
  }
  if (grid.timed) keys.emplace_back(kTimeRate);
  for (const RowRange& block : blocks_of(table)) {
    sort_block(table, block, keys, options.sort);
    if (grid.ranked) mark_columns(table, block, grid);
  }
}

TextTable sequence_blocks(const RateGrid& grid, const TableOptions& options) {
  TextTable table{grid.title, "method", {{"", grid.rates}}, {}, {}};
  if (grid.timed) table.groups[0].columns.emplace_back(kTimeHeading);
  for (std::size_t i = 0; i < grid.sequences.size(); ++i) {
    for (const MethodRates& method : grid.methods) {
      // What others printed stands beside their own sequences only.
      if (method.printed_digits > 0 && method.by_sequence[i] == nullptr) continue;
      TableRow row{method.heading, {}, false, grid.sequences[i]};
      for (const std::string& rate : grid.rates) {
        row.cells.push_back({rate_cell_text(method, i, rate, options)});
      }
      if (grid.timed) row.cells.push_back({time_cell_text(method.ms[i])});
      table.rows.push_back(std::move(row));
    }
  }
  finish_blocks(table, grid, options);
  return table;
}

bool is_complete(const MethodRates& method) {
  return std::all_of(method.by_sequence.begin(), method.by_sequence.end(),
                     [](const RateValues* known) { return known != nullptr; });
}

TextTable mean_block(const RateGrid& grid, const TableOptions& options) {
  TextTable table{
      grid.title + ", mean over " + std::to_string(grid.sequences.size()) + " sequences",
      "method",
      {{"", mean_names(grid)}},
      {},
      {}};
  const bool both_averages = has_f1_of_means(grid);
  if (both_averages) table.groups[0].columns.emplace_back(kF1OfMeans);
  if (grid.timed) table.groups[0].columns.emplace_back(kTimeHeading);
  for (const MethodRates& method : grid.methods) {
    if (method.printed_digits > 0 && !is_complete(method)) continue;
    TableRow row{method.heading, {}, false};
    for (const std::string& rate : grid.rates) {
      row.cells.push_back({mean_text(options, rate, method.values(rate), method.printed_digits)});
    }
    if (both_averages) row.cells.push_back({method.f1_of_means_text(options)});
    if (grid.timed) row.cells.push_back({time_cell_text(method.mean_ms)});
    table.rows.push_back(std::move(row));
  }
  finish_blocks(table, grid, options);
  return table;
}

/// The methods in the order that the options ask for, by their means.
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

/// Marks each rate of a row over the methods that stand side by side.
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
  TableRow f1_of_means{kF1OfMeans, {}, true};
  for (const MethodRates* method : methods) {
    for (const std::string& rate : grid.rates) {
      means.cells.push_back(
          {mean_text(options, rate, method->values(rate), method->printed_digits)});
      f1_of_means.cells.push_back({rate == "F1" ? method->f1_of_means_text(options) : ""});
    }
  }
  table.rows.push_back(std::move(means));
  if (has_f1_of_means(grid)) table.rows.push_back(std::move(f1_of_means));
}

}  // namespace

std::optional<double> MethodRates::rate(std::size_t sequence, const std::string& name) const {
  if (by_sequence[sequence] == nullptr) return std::nullopt;
  const auto found = by_sequence[sequence]->find(name);
  return found == by_sequence[sequence]->end() ? std::nullopt : found->second;
}

std::vector<std::optional<double>> MethodRates::values(const std::string& name) const {
  std::vector<std::optional<double>> list;
  for (std::size_t i = 0; i < by_sequence.size(); ++i) list.push_back(rate(i, name));
  return list;
}

std::string MethodRates::f1_of_means_text(const TableOptions& options) const {
  std::vector<SegmentRates> segments;
  for (std::size_t i = 0; i < by_sequence.size(); ++i) {
    segments.push_back({rate(i, "PR"), rate(i, "RR"), rate(i, "F1")});
  }
  const Mean mean = average_rates(segments).F1_of_means;
  if (!mean.value) return "n/a";
  const std::string text = option_text(options, "F1", *mean.value, printed_digits);
  return mean.segments == segments.size() ? text
                                          : text + " (" + std::to_string(mean.segments) + "/" +
                                                std::to_string(segments.size()) + ")";
}

std::string mean_text(const TableOptions& options, const std::string& rate,
                      const std::vector<std::optional<double>>& values, int printed) {
  const Mean mean = mean_of(values);
  if (!mean.value) return "n/a";
  const std::string text = option_text(options, rate, *mean.value, printed);
  if (mean.segments == values.size()) return text;
  return text + " (" + std::to_string(mean.segments) + "/" + std::to_string(values.size()) + ")";
}

std::vector<TextTable> method_rows(const RateGrid& grid, const TableOptions& options) {
  std::vector<TextTable> tables = {sequence_blocks(grid, options)};
  if (grid.ranked && grid.sequences.size() > 1) tables.push_back(mean_block(grid, options));
  return tables;
}

TextTable methods_side_by_side(const RateGrid& grid, const TableOptions& options) {
  TextTable table{grid.title, "sequence", {}, {}, {}};
  const std::vector<const MethodRates*> methods = sorted_methods(grid, options);
  for (const MethodRates* method : methods) table.groups.push_back({method->heading, grid.rates});
  for (std::size_t i = 0; i < grid.sequences.size(); ++i) {
    TableRow row{grid.sequences[i], {}, false};
    for (const MethodRates* method : methods) {
      for (const std::string& rate : grid.rates) {
        row.cells.push_back({rate_cell_text(*method, i, rate, options)});
      }
    }
    table.rows.push_back(std::move(row));
  }
  if (!grid.ranked) return table;
  add_mean_rows(grid, methods, options, table);
  for (TableRow& row : table.rows) mark_row(row, grid.rates);
  return table;
}

std::vector<TextTable> rate_tables(const RateGrid& grid, const TableOptions& options) {
  if (options.layout == TableLayout::kMethodRows) return method_rows(grid, options);
  return {methods_side_by_side(grid, options)};
}

}  // namespace raymoval
