// SPDX-License-Identifier: MIT
#include "benchmark/text_table.h"

#include <algorithm>
#include <numeric>

namespace raymoval {
namespace {

std::string markdown_escaped(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|' || c == '<' || c == '*') escaped += '\\';
    escaped += c == '\n' ? ' ' : c;
  }
  return escaped;
}

std::string markdown_cell(const TableCell& cell) {
  const std::string text = markdown_escaped(cell.text);
  if (cell.mark == Mark::kBest) return "**" + text + "**";
  if (cell.mark == Mark::kSecond) return "<u>" + text + "</u>";
  return text;
}

std::string latex_escaped(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '\\':
        escaped += "\\textbackslash{}";
        break;
      case '~':
        escaped += "\\textasciitilde{}";
        break;
      case '^':
        escaped += "\\textasciicircum{}";
        break;
      case '&':
      case '%':
      case '$':
      case '#':
      case '_':
      case '{':
      case '}':
        escaped += '\\';
        [[fallthrough]];
      default:
        escaped += c == '\n' ? ' ' : c;
    }
  }
  return escaped;
}

std::string latex_cell(const TableCell& cell) {
  const std::string text = latex_escaped(cell.text);
  if (cell.mark == Mark::kBest) return "\\textbf{" + text + "}";
  if (cell.mark == Mark::kSecond) return "\\underline{" + text + "}";
  return text;
}

/// Lines of already written cells; the first line holds the headings.
using Lines = std::vector<std::vector<std::string>>;

Lines markdown_lines(const TextTable& table) {
  Lines lines(1, {markdown_escaped(table.corner)});
  for (const TableGroup& group : table.groups) {
    for (std::size_t i = 0; i < group.columns.size(); ++i) {
      const std::string before = i == 0 && !group.heading.empty() ? group.heading + " " : "";
      lines[0].push_back(markdown_escaped(before + group.columns[i]));
    }
  }
  for (const TableRow& row : table.rows) {
    std::vector<std::string> line = {markdown_escaped(row.label)};
    for (const TableCell& cell : row.cells) line.push_back(markdown_cell(cell));
    lines.push_back(std::move(line));
  }
  return lines;
}

std::vector<std::size_t> column_widths(const Lines& lines) {
  std::vector<std::size_t> widths(lines.front().size(), 3);
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  return widths;
}

std::string latex_head(const TextTable& table, std::size_t columns) {
  std::string text = "\\begin{tabular}{l" + std::string(columns, 'r') + "}\n\\toprule\n";
  std::string rules;
  std::size_t at = 2;
  const bool headings = std::any_of(table.groups.begin(), table.groups.end(),
                                    [](const TableGroup& group) { return !group.heading.empty(); });
  for (const TableGroup& group : table.groups) {
    if (!headings) break;
    const std::size_t end = at + group.columns.size() - 1;
    text += " & \\multicolumn{" + std::to_string(group.columns.size()) + "}{c}{" +
            latex_escaped(group.heading) + "}";
    rules += "\\cmidrule(lr){" + std::to_string(at) + "-" + std::to_string(end) + "}";
    at = end + 1;
  }
  if (headings) text += " \\\\\n" + rules + "\n";
  text += latex_escaped(table.corner);
  for (const TableGroup& group : table.groups) {
    for (const std::string& column : group.columns) text += " & " + latex_escaped(column);
  }
  return text + " \\\\\n\\midrule\n";
}

}  // namespace

std::string to_markdown(const TextTable& table) {
  const Lines lines = markdown_lines(table);
  const std::vector<std::size_t> widths = column_widths(lines);
  std::string text = "## " + table.title + "\n\n";
  for (std::size_t row = 0; row < lines.size(); ++row) {
    for (std::size_t i = 0; i < lines[row].size(); ++i) {
      const std::string padding(widths[i] - lines[row][i].size(), ' ');
      text += i == 0 ? "| " + lines[row][i] + padding : " | " + padding + lines[row][i];
    }
    text += " |\n";
    if (row > 0) continue;
    for (std::size_t i = 0; i < widths.size(); ++i) {
      text += i == 0 ? "| " + std::string(widths[i], '-')
                     : " | " + std::string(widths[i] - 1, '-') + ":";
    }
    text += " |\n";
  }
  for (const std::string& note : table.notes) text += "\n" + note + "\n";
  return text;
}

std::string to_latex(const TextTable& table) {
  const std::size_t columns = std::accumulate(
      table.groups.begin(), table.groups.end(), std::size_t{0},
      [](std::size_t sum, const TableGroup& group) { return sum + group.columns.size(); });
  std::string text = "% needs \\usepackage{booktabs}\n\\begin{table}\n\\centering\n\\caption{" +
                     latex_escaped(table.title) + "}\n" + latex_head(table, columns);
  bool in_summary = false;
  for (const TableRow& row : table.rows) {
    if (row.summary && !in_summary) text += "\\midrule\n";
    in_summary = row.summary;
    text += latex_escaped(row.label);
    for (const TableCell& cell : row.cells) text += " & " + latex_cell(cell);
    text += " \\\\\n";
  }
  text += "\\bottomrule\n\\end{tabular}\n";
  for (const std::string& note : table.notes) text += "\n" + latex_escaped(note) + "\n";
  return text + "\\end{table}\n";
}

}  // namespace raymoval
