// SPDX-License-Identifier: MIT
#include <algorithm>

#include "benchmark/report/sections.h"
#include "core/text.h"
#include "eval/columns/columns.h"

namespace raymoval {
namespace {

/// The part that a column is about: "range 0-10 m" for "rejection [range 0-10 m]", and "all" for
/// "rejection". It has no value for other columns and for classes within a band.
std::optional<std::string> part_of(const std::string& column, const std::string& kind) {
  const ColumnName name = parse_column_name(column);
  if (name.kind != kind || (!name.group.empty() && !name.axis.empty())) return std::nullopt;
  if (!name.group.empty()) return name.group;
  return name.axis.empty() ? "all" : name.axis + " " + name.band;
}

/// A table of what is lost of each part, with a column for each method.
/// @param kind the name of the columns that hold what is not lost
TextTable loss_table(const std::vector<const MethodColumns*>& methods, const std::string& kind,
                     const std::string& title) {
  TextTable table{title, "of", {{"", {"points"}}}, {}, {}};
  for (const MethodColumns* method : methods) table.groups[0].columns.push_back(method->cell);
  std::vector<std::string> columns;
  for (const MethodColumns* method : methods) {
    for (const auto& [name, share] : method->values) {
      const bool known = std::find(columns.begin(), columns.end(), name) != columns.end();
      if (!known && part_of(name, kind)) columns.push_back(name);
    }
  }
  for (const std::string& column : columns) {
    std::int64_t points = 0;
    for (const MethodColumns* method : methods)
      points = std::max(points, method->find(column).whole);
    if (points == 0) continue;
    TableRow row{
        *part_of(column, kind), {{grouped_text(static_cast<std::uint64_t>(points))}}, false};
    for (const MethodColumns* method : methods) {
      const auto kept = method->find(column).percent();
      row.cells.push_back(kept ? number_cell(100.0 - *kept, 2) : TableCell{"n/a"});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

std::string losses_html(const ReportContent& content) {
  std::vector<const MethodColumns*> methods;
  for (const MethodColumns& method : content.results->columns) {
    if (!method.control) methods.push_back(&method);
  }
  if (methods.empty()) return "";
  std::string html;
  TextTable missed = loss_table(methods, "rejection", "Moving points that stay, in percent");
  TextTable lost = loss_table(methods, "preservation", "Static points that go, in percent");
  if (missed.rows.empty() && lost.rows.empty()) return "";
  missed.notes.push_back("Lower is better; the darker, the more is lost.");
  lost.notes.push_back(
      "Counts are added up over all sequences. Heights are above the road under the sensor. "
      "`raymoval table RUN --columns` has classes by range and height too.");
  for (const TextTable& table : {missed, lost}) {
    if (!table.rows.empty()) html += html_heat_table(table);
  }
  return html;
}

}  // namespace raymoval
