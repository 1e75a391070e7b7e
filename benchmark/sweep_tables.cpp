// SPDX-License-Identifier: MIT
#include "benchmark/sweep_tables.h"

#include <algorithm>

#include "benchmark/flat_sweeps.h"
#include "core/text.h"
#include "eval/averages.h"

namespace raymoval {
namespace {

/// Rates that a protocol gives, in the order of a curve: what is kept, what is removed, both in
/// one.
std::vector<std::string> curve_rates(const RunResults& results, const std::string& protocol) {
  std::vector<std::string> rates;
  for (const char* rate : {"PR", "RR", "F1", "SA", "DA", "HA"}) {
    const bool there = std::any_of(results.rows.begin(), results.rows.end(), [&](const auto& row) {
      return row.protocol == protocol && row.rates.count(rate) > 0;
    });
    if (there) rates.emplace_back(rate);
  }
  return rates;
}

TableCell rate_cell(const std::string& rate, const ResultRow* row) {
  if (row == nullptr) return {"not run"};
  if (row->status != "ok") return {row->status};
  const auto found = row->rates.find(rate);
  if (found == row->rates.end() || !found->second) return {"n/a"};
  return {rate_text(rate, *found->second)};
}

TableCell mean_cell(const std::string& rate, const std::vector<const ResultRow*>& rows) {
  std::vector<std::optional<double>> values;
  for (const ResultRow* row : rows) {
    const bool there = row != nullptr && row->rates.count(rate) > 0;
    values.push_back(there ? row->rates.at(rate) : std::nullopt);
  }
  const Mean mean = mean_of(values);
  if (!mean.value) return {"n/a"};
  std::string text = rate_text(rate, *mean.value);
  if (mean.segments < rows.size()) {
    text += " (" + std::to_string(mean.segments) + "/" + std::to_string(rows.size()) + ")";
  }
  return {text};
}

TableCell time_cell(const std::vector<const ResultRow*>& rows) {
  std::vector<std::optional<double>> values;
  for (const ResultRow* row : rows) {
    values.push_back(row != nullptr ? row->seconds_per_scan : std::nullopt);
  }
  const Mean mean = mean_of(values);
  return {mean.value ? fixed_text(1000.0 * *mean.value, 1) : "n/a"};
}

/// Marks the largest value of a column, as displayed.
void mark_best(TextTable& table, std::size_t column) {
  const auto value_of = [&](const TableRow& row) {
    const std::string& text = row.cells[column].text;
    return parse_number<double>(std::string_view(text).substr(0, text.find(' ')));
  };
  std::optional<double> best;
  for (const TableRow& row : table.rows) {
    const auto value = value_of(row);
    if (value && (!best || *value > *best)) best = value;
  }
  for (TableRow& row : table.rows) {
    if (best && value_of(row) == best) row.cells[column].mark = Mark::kBest;
  }
}

std::string point_text(const SweptCell& swept) {
  std::vector<std::string> values;
  for (const auto& [key, value] : swept.values) values.push_back(value);
  return join(values);
}

std::string point_heading(const SweptCell& swept) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : swept.values) keys.push_back(key);
  return join(keys);
}

TableRow point_row(const RunResults& results, const SweptCell& swept, const std::string& protocol,
                   const std::vector<std::string>& rates) {
  TableRow row{point_text(swept), {}, false};
  std::vector<const ResultRow*> rows;
  for (const std::string& sequence : results.sequences) {
    rows.push_back(results.find(sequence, swept.cell, protocol));
    for (const std::string& rate : rates) row.cells.push_back(rate_cell(rate, rows.back()));
  }
  if (rows.size() > 1) {
    for (const std::string& rate : rates) row.cells.push_back(mean_cell(rate, rows));
  }
  row.cells.push_back(time_cell(rows));
  return row;
}

TextTable sweep_table(const RunResults& results, const std::string& of,
                      const std::string& protocol) {
  const std::vector<std::string> rates = curve_rates(results, protocol);
  TextTable table{"Sweep of " + of + " by protocol " + protocol, "", {}, {}, {}};
  for (const std::string& sequence : results.sequences) table.groups.push_back({sequence, rates});
  if (results.sequences.size() > 1) table.groups.push_back({"mean", rates});
  table.groups.push_back({"", {"ms per scan"}});
  for (const SweptCell& swept : results.sweeps) {
    if (swept.of != of) continue;
    table.corner = point_heading(swept);
    table.rows.push_back(point_row(results, swept, protocol, rates));
  }
  for (std::size_t i = 0; i + 1 < table.rows.front().cells.size(); ++i) {
    const std::string& rate = rates[i % rates.size()];
    if (rate == "F1" || rate == "HA") mark_best(table, i);
  }
  table.notes.push_back(
      "Each row is a point of the curve of what is kept against what is removed.");
  for (const std::string& line : flat_sweeps(results, of)) table.notes.push_back(line);
  return table;
}

}  // namespace

std::vector<TextTable> sweep_tables(const RunResults& results) {
  std::vector<std::string> swept;
  for (const SweptCell& cell : results.sweeps) {
    if (std::find(swept.begin(), swept.end(), cell.of) == swept.end()) swept.push_back(cell.of);
  }
  std::vector<TextTable> tables;
  for (const std::string& protocol : results.protocols) {
    for (const std::string& of : swept) tables.push_back(sweep_table(results, of, protocol));
  }
  return tables;
}

}  // namespace raymoval
