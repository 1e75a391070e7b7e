// SPDX-License-Identifier: MIT
#include "benchmark/tables/text/text_table.h"

#include <algorithm>
#include <functional>
#include <set>
#include <string_view>

#include "core/text.h"
#include "core/utf8.h"

namespace raymoval {
namespace {

/// Where character `number` of a UTF-8 text begins, from 0.
std::size_t character_at(const std::string& text, std::size_t number) {
  std::size_t at = 0;
  for (; at < text.size(); ++at) {
    if (begins_character(text[at]) && number-- == 0) break;
  }
  return at;
}

std::string markdown_cell(const TableCell& cell) {
  const std::string text = markdown_text(cell.text);
  if (cell.mark == Mark::kBest) return "**" + text + "**";
  if (cell.mark == Mark::kSecond) return "<u>" + text + "</u>";
  return text;
}

/// Lines of already written cells; the first line holds the headings.
using Lines = std::vector<std::vector<std::string>>;

Lines markdown_lines(const TextTable& table) {
  Lines lines(1, {markdown_text(table.corner)});
  for (const TableGroup& group : table.groups) {
    for (std::size_t i = 0; i < group.columns.size(); ++i) {
      const std::string before = i == 0 && !group.heading.empty() ? group.heading + " " : "";
      lines[0].push_back(markdown_text(before + group.columns[i]));
    }
  }
  for (const TableRow& row : table.rows) {
    std::vector<std::string> line = {markdown_text(row.label)};
    for (const TableCell& cell : row.cells) line.push_back(markdown_cell(cell));
    lines.push_back(std::move(line));
  }
  return lines;
}

std::vector<std::size_t> column_widths(const Lines& lines) {
  std::vector<std::size_t> widths(lines.front().size(), 3);
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) {
      widths[i] = std::max(widths[i], character_count(line[i]));
    }
  }
  return widths;
}

std::string line_text(const std::vector<std::string>& line,
                      const std::vector<std::size_t>& widths) {
  std::string text;
  for (std::size_t i = 0; i < line.size(); ++i) {
    text += i == 0 ? "| " + padded(line[i], widths[i]) : " | " + padded_left(line[i], widths[i]);
  }
  return text + " |\n";
}

std::string rule_text(const std::vector<std::size_t>& widths) {
  std::string text;
  for (std::size_t i = 0; i < widths.size(); ++i) {
    text +=
        i == 0 ? "| " + std::string(widths[i], '-') : " | " + std::string(widths[i] - 1, '-') + ":";
  }
  return text + " |\n";
}

}  // namespace

std::string markdown_text(const std::string& text, std::string_view special) {
  std::string escaped;
  for (const char c : printable_text(text)) {
    if (special.find(c) != std::string_view::npos) escaped += '\\';
    escaped += c;
  }
  return escaped;
}

TableCell number_cell(double number, int decimals) {
  const std::string text = fixed_text(number, decimals);
  // Rounded in the same way as the text.
  return {text, Mark::kNone, parse_number<double>(text)};
}

TableCell number_or(const std::optional<double>& number, int decimals, const char* none) {
  return number ? number_cell(*number, decimals) : TableCell{none};
}

void mark_best(const std::vector<TableCell*>& cells, bool higher_is_better) {
  std::set<double, std::greater<>> ranks;  // The largest is the best.
  const auto rank_of = [&](const TableCell& cell) {
    return higher_is_better ? *cell.value : -*cell.value;
  };
  std::size_t numbers = 0;
  for (const TableCell* cell : cells) {
    if (!cell->value) continue;
    ranks.insert(rank_of(*cell));
    ++numbers;
  }
  if (numbers < 2) return;
  for (TableCell* cell : cells) {
    if (!cell->value) continue;
    if (rank_of(*cell) == *ranks.begin()) cell->mark = Mark::kBest;
    if (ranks.size() > 1 && rank_of(*cell) == *std::next(ranks.begin())) cell->mark = Mark::kSecond;
  }
}

void mark_best(TextTable& table, std::size_t place, bool higher_is_better, const RowRange& rows) {
  std::vector<TableCell*> cells;
  for (std::size_t i = rows.first; i < rows.end; ++i) {
    if (!table.rows[i].summary) cells.push_back(&table.rows[i].cells[place]);
  }
  mark_best(cells, higher_is_better);
}

void mark_best(TextTable& table, std::size_t place, bool higher_is_better) {
  mark_best(table, place, higher_is_better, {0, table.rows.size()});
}

std::vector<RowRange> blocks_of(const TextTable& table) {
  std::vector<RowRange> blocks;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (i == 0 || table.rows[i].block != table.rows[i - 1].block) blocks.push_back({i, i});
    blocks.back().end = i + 1;
  }
  return blocks;
}

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(width - std::min(width, character_count(text)), ' ');
}

std::string padded_left(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, character_count(text)), ' ') + text;
}

std::string shortened_middle(const std::string& text, std::size_t most) {
  const std::size_t length = character_count(text);
  if (length <= most) return text;
  const std::size_t head = (most - 3) / 2, tail = most - 3 - head;
  return text.substr(0, character_at(text, head)) + "..." +
         text.substr(character_at(text, length - tail));
}

std::string shortened_end(const std::string& text, std::size_t most) {
  if (character_count(text) <= most) return text;
  return text.substr(0, character_at(text, most - 3)) + "...";
}

std::string wrapped(const std::string& text, std::size_t most) {
  std::string lines, line;
  for (const std::string_view word : split_blanks(text)) {
    if (!line.empty() && character_count(line) + 1 + character_count(std::string(word)) > most) {
      lines += line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + std::string(word);
  }
  return lines + line + "\n";
}

std::string to_plain(const TextTable& table) {
  Lines lines(1, {table.corner});
  for (const TableGroup& group : table.groups) {
    for (const std::string& column : group.columns) lines[0].push_back(column + " ");
  }
  for (const TableRow& row : table.rows) {
    lines.push_back({row.label});
    for (const TableCell& cell : row.cells) {
      lines.back().push_back(cell.text + (cell.mark == Mark::kBest ? "*" : " "));
    }
  }
  const std::vector<std::size_t> widths = column_widths(lines);
  std::string text;
  for (const auto& line : lines) {
    std::string joined = padded(line[0], widths[0]);
    for (std::size_t i = 1; i < line.size(); ++i) joined += " " + padded_left(line[i], widths[i]);
    text += joined.substr(0, joined.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

std::string to_markdown(const TextTable& table) {
  const Lines lines = markdown_lines(table);
  const std::vector<std::size_t> widths = column_widths(lines);
  const std::string head = line_text(lines[0], widths) + rule_text(widths);
  std::string text = "## " + markdown_text(table.title) + "\n";
  if (table.rows.empty()) text += "\n" + head;
  for (const RowRange& block : blocks_of(table)) {
    const std::string& heading = table.rows[block.first].block;
    if (!heading.empty()) text += "\n### " + markdown_text(heading) + "\n";
    text += "\n" + head;
    for (std::size_t i = block.first; i < block.end; ++i) text += line_text(lines[i + 1], widths);
  }
  for (const std::string& note : table.notes) {
    text += "\n" + wrapped(markdown_text(note), kTerminalWidth);
  }
  return text;
}

}  // namespace raymoval
