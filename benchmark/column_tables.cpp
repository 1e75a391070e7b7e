// SPDX-License-Identifier: MIT
#include "benchmark/column_tables.h"

#include <algorithm>
#include <optional>

#include "core/text.h"

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

/// The class in "rejection [moving-car]"; nothing for bands, and for the bands of a class.
std::optional<std::string> class_in(const std::string& column, const std::string& kind) {
  const std::string start = kind + " [";
  if (!column.starts_with(start)) return std::nullopt;
  const std::string inner = column.substr(start.size(), column.size() - start.size() - 1);
  const bool band = inner.starts_with("range ") || inner.starts_with("height ");
  if (band || inner.find(',') != std::string::npos) return std::nullopt;
  return inner;
}

/// "moving-person 63.200": the class of which the smallest share was dealt with rightly.
std::string worst_class(const MethodColumns& method, const std::string& kind) {
  std::string text = "-";
  double worst = 101.0;
  for (const auto& [column, share] : method.values) {
    const auto name = class_in(column, kind);
    if (!name || share.whole < kNamedClassPoints || *share.percent() >= worst) continue;
    worst = *share.percent();
    text = *name + " " + percent_text(share);
  }
  return text;
}

/// Names of the columns of all methods, in the order of the first that has them.
std::vector<std::string> column_names(const std::vector<const MethodColumns*>& methods) {
  std::vector<std::string> names;
  for (const MethodColumns* method : methods) {
    for (const auto& [name, share] : method->values) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

/// @param wanted says which columns the table holds
template <class Wanted>
TextTable share_table(const std::string& title, const std::vector<const MethodColumns*>& methods,
                      Wanted&& wanted) {
  TextTable table{title, "column", {}, {}, {}};
  for (const MethodColumns* method : methods) table.groups.push_back({method->cell, {"%", "of"}});
  for (const std::string& name : column_names(methods)) {
    if (!wanted(name)) continue;
    TableRow row{name, {}, false};
    for (const MethodColumns* method : methods) {
      const Share share = method->find(name);
      row.cells.push_back({percent_text(share)});
      row.cells.push_back({std::to_string(share.whole)});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

bool is_general(const std::string& name) {
  const auto& columns = general_columns();
  return std::any_of(columns.begin(), columns.end(),
                     [&](const Column& column) { return column.name == name; });
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

TextTable interval_table(const RunResults& results, const std::string& protocol) {
  TextTable table{"Intervals by protocol " + protocol, "sequence, method", {{"", {}}}, {}, {}};
  std::vector<std::string>& rates = table.groups[0].columns;
  for (const char* rate : {"PR", "RR", "F1", "SA", "DA", "AA", "HA"}) {
    const bool there = std::any_of(results.rows.begin(), results.rows.end(), [&](const auto& row) {
      return row.protocol == protocol && row.intervals.contains(rate);
    });
    if (there) rates.push_back(rate);
  }
  for (const ResultRow& row : results.rows) {
    if (row.protocol != protocol || row.intervals.empty()) continue;
    table.rows.push_back({row.sequence + ", " + row.cell, {}, false});
    for (const std::string& rate : rates) {
      const auto found = row.intervals.find(rate);
      const bool there = found != row.intervals.end();
      table.rows.back().cells.push_back({there ? rate_text(rate, found->second.first) + " to " +
                                                     rate_text(rate, found->second.second)
                                               : "n/a"});
    }
  }
  table.notes.push_back(
      "95 % of the replicates of a circular block bootstrap over scans; map and verdicts are held "
      "fixed, so this is how much a rate hangs on which scans were counted.");
  return table;
}

}  // namespace

std::vector<TextTable> compact_column_tables(const RunResults& results) {
  const std::vector<const MethodColumns*> methods = shown_methods(results, false);
  if (methods.empty()) return {};
  TextTable table{
      "Points removed",
      "method",
      {{"",
        {"precision", "recall", "residue", "preservation", "worst mover", "worst static class"}}},
      {},
      {}};
  for (const MethodColumns* method : methods) {
    TableRow row{method->cell, {}, false};
    for (const char* name : {"precision", "recall", "residue", "preservation"}) {
      row.cells.push_back({percent_text(method->find(name))});
    }
    row.cells.push_back({worst_class(*method, "rejection")});
    row.cells.push_back({worst_class(*method, "preservation")});
    table.rows.push_back(std::move(row));
  }
  table.notes.push_back(
      "In percent of points, all sequences together. precision: moving ones of the removed; "
      "recall: "
      "removed ones of the moving; residue: moving ones of the kept; preservation: kept ones of "
      "the "
      "static. Of the classes with " +
      std::to_string(kNamedClassPoints) +
      " points or more, the mover least removed and the static class least kept. `raymoval table "
      "RUN --columns` has every class, range and height.");
  return {table};
}

std::vector<TextTable> full_column_tables(const RunResults& results) {
  std::vector<TextTable> tables;
  const std::vector<const MethodColumns*> methods = shown_methods(results, true);
  if (!methods.empty()) {
    tables.push_back(share_table("Columns", methods, is_general));
    tables.back().notes.push_back(general_notes());
    for (const char* kind : {"rejection", "preservation"}) {
      const std::string start = std::string(kind) + " [";
      tables.push_back(share_table(
          "Columns by class: " + std::string(kind), methods,
          [&](const std::string& name) { return name.starts_with(start) && !is_general(name); }));
    }
  }
  for (const std::string& protocol : results.protocols) {
    TextTable table = interval_table(results, protocol);
    if (!table.rows.empty()) tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace raymoval
