// SPDX-License-Identifier: MIT
#include "benchmark/report/html.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "core/text.h"

namespace raymoval {
namespace {

/// Whether a text begins with a number: "98.123 (4/5)", "1,234".
bool begins_with_number(const std::string& text) {
  std::string number = text.substr(0, text.find(' '));
  std::erase(number, ',');
  return parse_number<double>(number).has_value();
}

/// Whether column `place` holds numbers and, maybe, words for their lack.
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

std::vector<bool> number_columns(const TextTable& table) {
  std::vector<bool> numbers;
  for (const TableGroup& group : table.groups) {
    for (std::size_t i = 0; i < group.columns.size(); ++i) {
      numbers.push_back(holds_numbers(table, numbers.size()));
    }
  }
  return numbers;
}

std::vector<bool> group_starts(const TextTable& table) {
  std::vector<bool> starts;
  for (const TableGroup& group : table.groups) {
    for (std::size_t i = 0; i < group.columns.size(); ++i) starts.push_back(i == 0);
  }
  return starts;
}

std::string classes(bool number, bool start) {
  if (!number && !start) return "";
  return std::string(" class=\"") + (number ? "number" : "") + (number && start ? " " : "") +
         (start ? "start" : "") + "\"";
}

std::string head_html(const TextTable& table) {
  const bool grouped = std::any_of(table.groups.begin(), table.groups.end(),
                                   [](const TableGroup& group) { return !group.heading.empty(); });
  const std::string corner = html_text(table.corner);
  std::string html = "<thead>";
  if (grouped) {
    html += "<tr><th scope=\"col\" rowspan=\"2\">" + corner + "</th>";
    for (const TableGroup& group : table.groups) {
      const std::string span = "colspan=\"" + std::to_string(group.columns.size()) + "\">";
      html += group.heading.empty() ? "<td " + span + "</td>"
                                    : "<th scope=\"colgroup\" class=\"group\" " + span +
                                          html_text(group.heading) + "</th>";
    }
    html += "</tr>\n";
  }
  html += grouped ? "<tr>" : "<tr><th scope=\"col\">" + corner + "</th>";
  const std::vector<bool> numbers = number_columns(table), starts = group_starts(table);
  std::size_t place = 0;
  for (const TableGroup& group : table.groups) {
    for (const std::string& column : group.columns) {
      html += "<th scope=\"col\"" + classes(numbers[place], grouped && starts[place]) + ">" +
              html_text(column) + "</th>";
      ++place;
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

/// The ground of a cell by its percents, so that 1 % can be seen and 50 % is not all.
std::string heat_of(const TableCell& cell) {
  if (!cell.value) return "";
  const double share = std::clamp(std::sqrt(*cell.value / 100.0), 0.0, 1.0) * 0.75;
  return " style=\"--share:" + fixed_text(share, 2) + "\"";
}

std::string rows_html(const TextTable& table, const RowRange& range, bool summary, bool heat) {
  const std::vector<bool> numbers = number_columns(table), starts = group_starts(table);
  const bool lines = table.groups.size() > 1;
  std::string html;
  for (std::size_t r = range.first; r < range.end; ++r) {
    const TableRow& row = table.rows[r];
    if (row.summary != summary) continue;
    html += "<tr><th scope=\"row\">" + html_text(row.label) + "</th>";
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      if (heat && i > 0) {
        html += "<td class=\"number heat\"" + heat_of(row.cells[i]) + ">";
      } else {
        html += "<td" + classes(numbers[i], lines && starts[i]) + ">";
      }
      html += marked(row.cells[i]) + "</td>";
    }
    html += "</tr>\n";
  }
  return html;
}

/// A <tbody> for each block; a block with a name has a row with it above its own.
std::string bodies_html(const TextTable& table, bool heat) {
  const std::string span = std::to_string(number_columns(table).size() + 1);
  std::string html;
  for (const RowRange& block : blocks_of(table)) {
    const std::string& heading = table.rows[block.first].block;
    html += "<tbody>";
    if (!heading.empty()) {
      html += "<tr class=\"block\"><th scope=\"rowgroup\" colspan=\"" + span + "\">" +
              html_text(heading) + "</th></tr>\n";
    }
    html += rows_html(table, block, false, heat) + "</tbody>";
  }
  return html.empty() ? "<tbody></tbody>" : html;
}

std::string whole_table(const TextTable& table, TableHeight height, bool heat) {
  const std::string title = html_text(table.title);
  std::string html = std::string("<div class=\"scroll") +
                     (height == TableHeight::kScrolled ? " tall" : "") +
                     "\" tabindex=\"0\" role=\"region\" aria-label=\"" + title +
                     "\">\n<table class=\"sortable\"><caption>" + title + "</caption>\n" +
                     head_html(table) + bodies_html(table, heat);
  const std::string foot = rows_html(table, {0, table.rows.size()}, true, heat);
  if (!foot.empty()) html += "\n<tfoot>" + foot + "</tfoot>";
  html += "</table></div>\n";
  for (const std::string& note : table.notes)
    html += "<p class=\"note\">" + html_text(note) + "</p>\n";
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

std::string html_id(const std::string& text) {
  std::string id;
  for (const char c : text) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    id += plain ? c : '-';
  }
  return id;
}

std::string script_json(const nlohmann::ordered_json& json) {
  using nlohmann::ordered_json;
  const std::string text = json.dump(-1, ' ', true, ordered_json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      safe += "\\u003c";  // Only texts have it.
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string html_table(const TextTable& table, TableHeight height) {
  return whole_table(table, height, false);
}

std::string html_heat_table(const TextTable& table) {
  return whole_table(table, TableHeight::kWhole, true);
}

std::string html_section(const PageSection& section) {
  return "<section id=\"" + section.id + "\" aria-labelledby=\"" + section.id +
         "-title\">\n<h2 id=\"" + section.id + "-title\">" + html_text(section.title) + "</h2>\n" +
         section.html + "</section>\n";
}

std::string html_list(const std::vector<std::string>& lines) {
  std::string html = "<ul class=\"changes\">\n";
  for (const std::string& line : lines) html += "<li>" + html_text(line) + "</li>\n";
  return html + "</ul>\n";
}

}  // namespace raymoval
