// SPDX-License-Identifier: MIT
#include "benchmark/report/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "core/text.h"
#include "core/utf8.h"

namespace raymoval {
namespace {

/// Whether a text begins with a number: "98.123 (4/5)", "1,234".
bool begins_with_number(const std::string& text) {
  std::string number = text.substr(0, text.find(' '));
  std::erase(number, ',');
  return parse_number<double>(number).has_value();
}

/// Whether column `place` holds numbers and possibly words for missing ones.
bool holds_numbers(const TextTable& table, std::size_t place) {
  bool any = false;
  for (const TableRow& row : table.rows) {
    const std::string& text = row.cells[place].text;
    if (begins_with_number(text)) {
      any = true;
    } else if (text.find(' ') != std::string::npos || text.size() > 13) {
      return false;
    }
  }
  return any;
}

/// How the cells of a column look.
struct ColumnStyle {
  bool number = false, start = false;  ///< It holds numbers; it begins a group.

  [[nodiscard]] std::string classes(bool with_lines) const {
    const bool line = start && with_lines;
    if (!number && !line) return "";
    return fmt::format(" class=\"{}\"", number && line ? "number start"
                                        : number       ? "number"
                                                       : "start");
  }
};

std::vector<ColumnStyle> column_styles(const TextTable& table) {
  std::vector<ColumnStyle> looks;
  for (const TableGroup& group : table.groups) {
    for (std::size_t i = 0; i < group.columns.size(); ++i) {
      looks.push_back({holds_numbers(table, looks.size()), i == 0});
    }
  }
  return looks;
}

std::string head_html(const TextTable& table, const std::vector<ColumnStyle>& looks) {
  const bool grouped = std::any_of(table.groups.begin(), table.groups.end(),
                                   [](const TableGroup& group) { return !group.heading.empty(); });
  const std::string corner = html_text(table.corner);
  std::string html = "<thead>";
  if (grouped) {
    html += "<tr><th scope=\"col\" rowspan=\"2\">" + corner + "</th>";
    for (const TableGroup& group : table.groups) {
      html +=
          fmt::format(fmt::runtime(group.heading.empty() ? "<td colspan=\"{}\"></td>"
                                                         : "<th scope=\"colgroup\" class=\"group\" "
                                                           "colspan=\"{}\">{}</th>"),
                      group.columns.size(), html_text(group.heading));
    }
    html += "</tr>\n";
  }
  html += grouped ? "<tr>" : "<tr><th scope=\"col\">" + corner + "</th>";
  auto look = looks.begin();
  for (const TableGroup& group : table.groups) {
    for (const std::string& column : group.columns) {
      html +=
          fmt::format("<th scope=\"col\"{}>{}</th>", look++->classes(grouped), html_text(column));
    }
  }
  return html + "</tr></thead>\n";
}

std::string marked(const TableCell& cell) {
  const std::string text = html_text(cell.text);
  if (cell.mark == Mark::kBest) return "<strong>" + text + "</strong>";
  if (cell.mark == Mark::kSecond) return "<u>" + text + "</u>";
  return text;
}

/// The background of a cell by its percentage: 1 % is visible, and 50 % is not yet the darkest.
std::string heat_of(const TableCell& cell) {
  if (!cell.value) return "";
  const double share = std::clamp(std::sqrt(*cell.value / 100.0), 0.0, 1.0) * 0.75;
  return " style=\"--share:" + fixed_text(share, 2) + "\"";
}

std::string rows_html(const TextTable& table, const std::vector<ColumnStyle>& looks,
                      const RowRange& range, bool summary, bool heat) {
  const bool lines = table.groups.size() > 1;
  std::string html;
  for (std::size_t r = range.first; r < range.end; ++r) {
    const TableRow& row = table.rows[r];
    if (row.summary != summary) continue;
    html += "<tr><th scope=\"row\">" + html_name(row.label) + "</th>";
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      const std::string look = heat && i > 0 ? " class=\"number heat\"" + heat_of(row.cells[i])
                                             : looks[i].classes(lines);
      html += fmt::format("<td{}>{}</td>", look, marked(row.cells[i]));
    }
    html += "</tr>\n";
  }
  return html;
}

/// A <tbody> for each block. If a block has a name, the first row of its <tbody> shows it.
std::string bodies_html(const TextTable& table, const std::vector<ColumnStyle>& looks, bool heat) {
  std::string html;
  for (const RowRange& block : blocks_of(table)) {
    const std::string& heading = table.rows[block.first].block;
    html += "<tbody>";
    if (!heading.empty()) {
      html +=
          fmt::format("<tr class=\"block\"><th scope=\"rowgroup\" colspan=\"{}\">{}</th></tr>\n",
                      looks.size() + 1, html_text(heading));
    }
    html += rows_html(table, looks, block, false, heat) + "</tbody>";
  }
  return html.empty() ? "<tbody></tbody>" : html;
}

std::string whole_table(const TextTable& table, TableHeight height, bool heat) {
  const std::vector<ColumnStyle> looks = column_styles(table);
  const std::string foot = rows_html(table, looks, {0, table.rows.size()}, true, heat);
  std::string html = fmt::format(
      "<div class=\"scroll{0}\" tabindex=\"0\" role=\"region\" aria-label=\"{1}\">\n"
      "<table class=\"sortable\"><caption>{1}</caption>\n{2}{3}{4}</table></div>\n",
      height == TableHeight::kScrolled ? " tall" : "", html_text(table.title),
      head_html(table, looks), bodies_html(table, looks, heat),
      foot.empty() ? "" : "\n<tfoot>" + foot + "</tfoot>");
  for (const std::string& note : table.notes) {
    html += fmt::format("<p class=\"note\">{}</p>\n", html_text(note));
  }
  return html;
}

}  // namespace

std::string html_text(const std::string& text) {
  return xml_escaped(text);
}

std::string html_name(const std::string& name) {
  std::string html, piece;
  for (std::size_t i = 0; i < name.size(); ++i) {
    piece += name[i];
    if (std::string_view(":_/=,").find(name[i]) == std::string_view::npos || i + 1 == name.size()) {
      continue;
    }
    html += html_text(piece) + "<wbr>";
    piece.clear();
  }
  return html + html_text(piece);
}

std::string html_table(const TextTable& table, TableHeight height) {
  return whole_table(table, height, false);
}

std::string html_heat_table(const TextTable& table) {
  return whole_table(table, TableHeight::kWhole, true);
}

std::string html_section(const PageSection& section) {
  return fmt::format(
      "<section id=\"{0}\" aria-labelledby=\"{0}-title\">\n<h2 id=\"{0}-title\">{1}</h2>\n"
      "{2}</section>\n",
      section.id, html_text(section.title), section.html);
}

std::string html_list(const std::vector<std::string>& lines) {
  std::string html = "<ul class=\"changes\">\n";
  for (const std::string& line : lines) html += "<li>" + html_text(line) + "</li>\n";
  return html + "</ul>\n";
}

}  // namespace raymoval
