// SPDX-License-Identifier: MIT
#include "benchmark/text_table.h"

#include <algorithm>

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

}  // namespace raymoval
