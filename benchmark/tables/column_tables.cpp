// SPDX-License-Identifier: MIT
#include "benchmark/tables/tables.h"

#include <algorithm>
#include <optional>

#include "core/text.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

std::string percent_text(const Share& share) {
  const auto percent = share.percent();
  return percent ? fixed_text(*percent, 3) : "n/a";
}

std::vector<const MethodColumns*> shown_methods(const RunResults& results, bool controls) {
  std::vector<const MethodColumns*> shown;
  for (const MethodColumns& method : results.columns) {
    if (controls || !method.control) shown.push_back(&method);
  }
  return shown;
}

/// "moving-person 63.200"
std::string worst_class_text(const MethodColumns& method, const std::string& kind) {
  const auto worst = worst_class(method, kind);
  return worst ? worst->name + " " + fixed_text(worst->percent, 3) : "-";
}

/// Names of the columns of all methods, in the order of the first that has them.
std::vector<std::string> column_names(const std::vector<const MethodColumns*>& methods) {
  std::vector<std::string> names;
  for (const MethodColumns* method : methods) {
    for (const auto& [name, share] : method->values) add_once(names, name);
  }
  return names;
}

/// The number of points of a column.
std::int64_t most_points(const std::vector<const MethodColumns*>& methods,
                         const std::string& name) {
  std::int64_t points = 0;
  for (const MethodColumns* method : methods) points = std::max(points, method->find(name).whole);
  return points;
}

/// The part of a column: "range 0-10 m" for "rejection [range 0-10 m]", and "all" for "rejection".
/// It has no value for other columns and for classes within a band.
std::optional<std::string> part_of(const std::string& column, const std::string& kind) {
  const ColumnName name = parse_column_name(column);
  if (name.kind != kind || (!name.group.empty() && !name.axis.empty())) return std::nullopt;
  if (!name.group.empty()) return name.group;
  return name.axis.empty() ? "all" : name.axis + " " + name.band;
}

/// A table of the share that each method loses, with a row for each part.
/// @param kind the name of the columns that hold the share that is kept
TextTable loss_table(const std::vector<const MethodColumns*>& methods, const std::string& kind,
                     const std::string& title) {
  TextTable table{title, "of", {{"", {"points"}}}};
  for (const MethodColumns* method : methods) table.groups[0].columns.push_back(method->cell);
  for (const std::string& column : column_names(methods)) {
    const std::optional<std::string> part = part_of(column, kind);
    const std::int64_t points = most_points(methods, column);
    if (!part || points == 0) continue;
    TableRow row{*part, {{grouped_text(static_cast<std::uint64_t>(points))}}};
    for (const MethodColumns* method : methods) {
      const auto kept = method->find(column).percent();
      row.cells.push_back(kept ? number_cell(100.0 - *kept, 2) : TableCell{"n/a"});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Figures for neither a class nor a band.
TextTable whole_table(const std::vector<const MethodColumns*>& methods) {
  TextTable table{"Columns", "method", {{"", {}}}};
  for (const std::string& name : column_names(methods)) {
    if (name == parse_column_name(name).kind) table.groups[0].columns.push_back(name);
  }
  for (const MethodColumns* method : methods) {
    TableRow& row = table.rows.emplace_back(TableRow{method->cell, {}});
    for (const std::string& name : table.groups[0].columns) {
      row.cells.push_back({percent_text(method->find(name))});
    }
  }
  return table;
}

std::string general_notes() {
  std::string text;
  for (const Column& column : general_columns()) {
    if (column.name.find('[') != std::string::npos) continue;
    text += (text.empty() ? "" : " ") + column.name + " (" +
            (column.better == Better::kHigher ? "higher" : "lower") +
            " is better): " + column.description;
  }
  return text + " Heights are those above the road under a sensor " + number_text(kHeightOffset) +
         " m above it.";
}

/// "99.131 to 99.689"; empty if there is no such interval.
std::string interval_text(const Score& score, const std::string& rate) {
  const Interval* interval = score.interval(rate);
  if (interval == nullptr) return "";
  return rate_text(rate, *interval->low) + " to " + rate_text(rate, *interval->high);
}

bool has_interval(const Score& score) {
  return score.intervals && std::ranges::any_of(score.intervals->rates, [](const auto& interval) {
           return interval.low.has_value();
         });
}

TextTable interval_table(const RunResults& results, const std::string& protocol) {
  TextTable table{"Intervals by protocol " + protocol, "method", {{"", {}}}};
  std::vector<const Cell*> cells;
  for (const Cell& cell : results.cells) {
    const Score* score = cell.score(protocol);
    if (score != nullptr && has_interval(*score)) cells.push_back(&cell);
  }
  std::vector<std::string>& rates = table.groups[0].columns;
  for (const std::string& rate : results.rates_of(protocol)) {
    const bool there = std::ranges::any_of(cells, [&](const Cell* cell) {
      return !interval_text(*cell->score(protocol), rate).empty();
    });
    if (there) rates.push_back(rate);
  }
  for (const Cell* cell : cells) {
    table.rows.push_back({cell->name, {}, false, cell->sequence});
    for (const std::string& rate : rates) {
      const std::string text = interval_text(*cell->score(protocol), rate);
      table.rows.back().cells.push_back({text.empty() ? "n/a" : text});
    }
  }
  table.notes.push_back(
      "95 % of the replicates of a circular block bootstrap over scans; map and verdicts are held "
      "fixed, so an interval shows how much a rate depends on the choice of scans.");
  return table;
}

TextTable reliability_table(const MethodReliability& method) {
  TextTable table{"Confidence of " + method.cell,
                  "confidence",
                  {{"", {"points", "mean confidence", "share that moves"}}}};
  for (std::size_t i = 0; i < kConfidenceBins; ++i) {
    const ReliabilityBin& bin = method.all.bins[i];
    const double width = 1.0 / static_cast<double>(kConfidenceBins);
    table.rows.push_back({fixed_text(static_cast<double>(i) * width, 1) + " to " +
                              fixed_text(static_cast<double>(i + 1) * width, 1),
                          {{grouped_text(static_cast<std::uint64_t>(bin.points))},
                           number_or(bin.mean_confidence(), 3, "-"),
                           number_or(bin.moving_share(), 3, "-")}});
  }
  const auto error = method.all.expected_error(), gap = method.all.mean_gap();
  table.notes.push_back(
      "By the points' labels, over " + counted_text(method.sequences, "sequence") +
      ". Expected calibration error " + (error ? fixed_text(*error, 5) : "-") +
      " (bins weighted by their points, nearly all of which are kept); mean gap " +
      (gap ? fixed_text(*gap, 3) : "-") + " (bins of " + std::to_string(kFewestInBin) +
      " points or more count alike).");
  return table;
}

}  // namespace

std::optional<ClassShare> worst_class(const MethodColumns& method, const std::string& kind) {
  std::optional<ClassShare> worst;
  for (const auto& [column, share] : method.values) {
    const ColumnName name = parse_column_name(column);
    if (name.kind != kind || name.group.empty() || !name.axis.empty()) continue;
    if (share.whole < kNamedClassPoints || (worst && *share.percent() >= worst->percent)) continue;
    worst = {name.group, *share.percent()};
  }
  return worst;
}

std::vector<TextTable> compact_column_tables(const RunResults& results) {
  const std::vector<const MethodColumns*> methods = shown_methods(results, false);
  if (methods.empty()) return {};
  std::vector<std::string> columns = {"precision",    "recall",      "residue",
                                      "preservation", "worst mover", "worst static class"};
  const bool has_objects = most_points(methods, kWorstParked) > 0;
  if (has_objects) columns.push_back(kWorstParked);
  TextTable table{"Points removed", "method", {{"", columns}}};
  for (const MethodColumns* method : methods) {
    TableRow& row = table.rows.emplace_back(TableRow{method->cell, {}});
    for (const char* name : {"precision", "recall", "residue", "preservation"}) {
      row.cells.push_back({percent_text(method->find(name))});
    }
    row.cells.push_back({worst_class_text(*method, "rejection")});
    row.cells.push_back({worst_class_text(*method, "preservation")});
    if (has_objects) row.cells.push_back({percent_text(method->find(kWorstParked))});
  }
  table.notes.push_back(
      "In percent of points, all sequences together. precision: share of removed points that move; "
      "recall: share of moving points that are removed; residue: share of kept points that move; "
      "preservation: share of static points that are kept. " +
      std::string(has_objects ? "parked worst: share kept of the parked object that loses most. "
                              : "") +
      "Of the classes with " + std::to_string(kNamedClassPoints) +
      " points or more, the worst are shown. `raymoval table RUN --what losses` has every class, "
      "range and height.");
  return {table};
}

std::vector<TextTable> loss_tables(const RunResults& results) {
  const std::vector<const MethodColumns*> methods = shown_methods(results, false);
  TextTable missed = loss_table(methods, "rejection", "Moving points that are kept, in percent");
  missed.notes.emplace_back("Lower is better.");
  TextTable lost =
      loss_table(methods, "preservation", "Static points that are removed, in percent");
  lost.notes.emplace_back(
      "Counts are added up over all sequences. Heights are above the road under the sensor.");
  std::vector<TextTable> tables = {std::move(missed), std::move(lost)};
  std::erase_if(tables, [](const TextTable& table) { return table.rows.empty(); });
  return tables;
}

std::vector<TextTable> column_tables(const RunResults& results) {
  const std::vector<const MethodColumns*> methods = shown_methods(results, true);
  if (methods.empty()) return {};
  TextTable table = whole_table(methods);
  table.notes.push_back(general_notes());
  return {table};
}

std::vector<TextTable> interval_tables(const RunResults& results) {
  std::vector<TextTable> tables;
  for (const std::string& protocol : results.protocols) {
    TextTable table = interval_table(results, protocol);
    if (!table.rows.empty()) tables.push_back(std::move(table));
  }
  return tables;
}

std::vector<TextTable> reliability_tables(const RunResults& results) {
  std::vector<TextTable> tables;
  for (const MethodReliability& method : results.reliability) {
    tables.push_back(reliability_table(method));
  }
  return tables;
}

}  // namespace raymoval
