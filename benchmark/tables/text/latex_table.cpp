// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include "benchmark/tables/text/text_table.h"
#include "core/text.h"
#include "core/utf8.h"

namespace raymoval {
namespace {

constexpr double kTextWidth = 345.0;    ///< Of an article at 10 pt, in points.
constexpr double kColumnWidth = 200.0;  ///< Of one with two columns; other classes have wider ones.
constexpr std::size_t kMostLines = 46;  ///< Of a float, so that it is not higher than a page.
constexpr std::size_t kLongText = 26;   ///< Characters; columns with more are broken into lines.

/// Widths of text, in points, slightly overestimated.
struct Measures {
  double character, gap;
};
constexpr Measures kNormal{5.4, 12.0};
constexpr Measures kSmall{4.5, 6.0};  ///< \footnotesize with \tabcolsep of 3 pt.

/// Reads a UTF-8 character that LaTeX supports without packages; '?' for others. `at` moves past
/// it.
std::string known_character(const std::string& text, std::size_t& at) {
  const auto first = static_cast<unsigned char>(text[at]);
  if (first < 0x80) return std::string(1, text[at++]);
  const auto second = at + 1 < text.size() ? static_cast<unsigned char>(text[at + 1]) : 0U;
  if (first == 0xC3 && (second & 0xC0U) == 0x80U && second != 0x97 && second != 0xB7) {
    at += 2;  // Letters from U+00C0 to U+00FF.
    return text.substr(at - 2, 2);
  }
  ++at;
  while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U) ++at;
  return "?";
}

/// A character as LaTeX shows it.
std::string escaped_character(const std::string& character) {
  static const std::map<char, std::string> commands = {
      {'\\', "\\textbackslash{}"},  {'~', "\\textasciitilde{}"},
      {'^', "\\textasciicircum{}"}, {'`', "\\`{}"},
      {'<', "\\textless{}"},        {'>', "\\textgreater{}"},
      {'|', "\\textbar{}"}};
  const auto command = commands.find(character.front());
  if (command != commands.end()) return command->second;
  const bool special = std::string_view("&%$#_{}").find(character) != std::string_view::npos;
  return (special ? "\\" : "") + character;
}

std::string latex_escaped(const std::string& any_text) {
  const std::string text = printable_text(any_text);
  std::string escaped;
  for (std::size_t at = 0; at < text.size();) {
    const std::string character = known_character(text, at);
    // Two of them would become a dash.
    if (character == "-" && escaped.ends_with('-')) escaped += "{}";
    escaped += escaped_character(character);
  }
  // After the end of a row, these would be read as its option, even after blanks.
  const std::size_t first = std::min(escaped.find_first_not_of(' '), escaped.size());
  const bool belongs = escaped[first] == '[' || escaped[first] == '*';
  return belongs ? "{}" + escaped : escaped;
}

/// "accuracy-by-protocol-erasor": the title in a form that \\label allows.
std::string label_of(const std::string& title) {
  std::string label;
  for (const char c : title) {
    const bool upper = c >= 'A' && c <= 'Z';
    const bool plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '*';
    if (upper || plain) {
      label += upper ? static_cast<char>(c - 'A' + 'a') : c;
    } else if (!label.ends_with('-')) {
      label += '-';
    }
  }
  return label;
}

/// The same for a column that is broken into lines: words may also be broken after these
/// characters.
std::string breakable(const std::string& text) {
  std::string broken;
  std::string piece;
  for (const char c : text) {
    piece += c;
    if (c != '/' && c != '_' && c != '.' && c != ':' && c != ',') continue;
    broken += latex_escaped(piece) + "\\allowbreak{}";
    piece.clear();
  }
  return broken + latex_escaped(piece);
}

/// A column with its heading.
struct LatexColumn {
  std::size_t group = 0;
  std::string name;
  std::size_t place = 0;  ///< Among the cells of a row.
  std::size_t characters = 0;
  bool is_long = false;
};

std::vector<LatexColumn> columns_of(const TextTable& table) {
  std::vector<LatexColumn> columns;
  for (std::size_t group = 0; group < table.groups.size(); ++group) {
    for (const std::string& name : table.groups[group].columns) {
      LatexColumn column{group, name, columns.size(), name.size(), false};
      for (const TableRow& row : table.rows) {
        column.characters = std::max(column.characters, row.cells[column.place].text.size());
      }
      column.is_long = column.characters > kLongText;
      columns.push_back(column);
    }
  }
  return columns;
}

/// Columns of a table that fit beside its row labels.
using ColumnBlock = std::vector<LatexColumn>;

/// The columns of each group.
std::vector<ColumnBlock> groups_of(const ColumnBlock& columns) {
  std::vector<ColumnBlock> groups;
  for (const LatexColumn& column : columns) {
    if (groups.empty() || groups.back().front().group != column.group) groups.emplace_back();
    groups.back().push_back(column);
  }
  return groups;
}

class LatexTable {
 public:
  explicit LatexTable(const TextTable& table) : table_(table), columns_(columns_of(table)) {
    label_characters_ = table.corner.size();
    for (const TableRow& row : table.rows) {
      label_characters_ = std::max(label_characters_, row.label.size());
    }
    has_headings_ = std::any_of(table.groups.begin(), table.groups.end(),
                                [](const TableGroup& group) { return !group.heading.empty(); });
    is_wide_ = whole_width(kSmall) > kColumnWidth;
    is_small_ = whole_width(kNormal) > (is_wide_ ? kTextWidth : kColumnWidth);
    cut();
    pack();
  }

  [[nodiscard]] std::string text() const {
    std::string text;
    for (std::size_t i = 0; i < floats_.size(); ++i) {
      text += (i == 0 ? "" : "\n") + float_text(floats_[i], i);
    }
    return text;
  }

 private:
  [[nodiscard]] const Measures& measures() const { return is_small_ ? kSmall : kNormal; }
  [[nodiscard]] double label_width(const Measures& by) const {
    return by.character * static_cast<double>(label_characters_) + by.gap;
  }
  [[nodiscard]] double whole_width(const Measures& by) const {
    return label_width(by) + width(columns_, by);
  }
  /// Of neighbouring columns, each group at least as wide as its heading. Long columns share what
  /// the others leave, and need 80 pt.
  [[nodiscard]] double width(const ColumnBlock& columns, const Measures& by) const {
    double sum = 0.0;
    for (const ColumnBlock& group : groups_of(columns)) {
      double width = 0.0;
      for (const LatexColumn& column : group) {
        const auto characters = static_cast<double>(column.characters);
        width += by.gap + (column.is_long ? 80.0 : by.character * characters);
      }
      const auto characters = static_cast<double>(heading_of(group).size());
      sum += std::max(width, by.gap + by.character * characters);
    }
    return sum;
  }

  [[nodiscard]] const std::string& heading_of(const ColumnBlock& group) const {
    return table_.groups[group.front().group].heading;
  }

  [[nodiscard]] double room_for_columns() const {
    return (is_wide_ ? kTextWidth : kColumnWidth) - label_width(measures());
  }

  /// Puts groups that fit into a block as a whole, larger groups column by column.
  void cut() {
    const double room = room_for_columns();
    blocks_.emplace_back();
    for (const ColumnBlock& unit : groups_of(columns_)) {
      if (width(unit, measures()) <= room) {
        append(unit, room);
      } else {
        for (const LatexColumn& column : unit) append({column}, room);
      }
    }
  }
  void append(const ColumnBlock& unit, double room) {
    ColumnBlock& last = blocks_.back();
    if (!last.empty() && width(last, measures()) + width(unit, measures()) > room) {
      blocks_.push_back(unit);
    } else {
      last.insert(last.end(), unit.begin(), unit.end());
    }
  }

  /// Fills floats with as many tabulars as a page holds: all rows for each column block, if
  /// possible in whole row blocks.
  void pack() {
    for (const ColumnBlock& block : blocks_) {
      const std::size_t around = 5 + (has_headings_ ? 1 : 0);
      for (const RowRange& rows : row_ranges(kMostLines - around)) {
        const std::size_t lines = around + lines_of(rows);
        if (floats_.empty() || floats_.back().lines + lines > kMostLines) floats_.push_back({});
        floats_.back().tabulars.push_back({&block, rows});
        floats_.back().lines += lines;
      }
    }
  }

  /// Each heading of a block and the space above it take two lines.
  [[nodiscard]] std::size_t lines_of(const RowRange& rows) const {
    std::size_t lines = rows.end - rows.first;
    for (std::size_t i = rows.first; i < rows.end; ++i) lines += starts_block(i, rows) ? 2 : 0;
    return lines;
  }
  [[nodiscard]] bool starts_block(std::size_t row, const RowRange& rows) const {
    const std::string& block = table_.rows[row].block;
    return !block.empty() && (row == rows.first || table_.rows[row - 1].block != block);
  }

  /// All rows in ranges of at most `most` lines, which end with a block where that is possible.
  [[nodiscard]] std::vector<RowRange> row_ranges(std::size_t most) const {
    std::vector<RowRange> ranges;
    for (RowRange block : blocks_of(table_)) {
      if (!ranges.empty()) {
        const RowRange joined{ranges.back().first, block.end};
        if (lines_of(joined) <= most) {
          ranges.back() = joined;
          continue;
        }
      }
      for (; lines_of(block) > most; block.first += most - 2) {
        ranges.push_back({block.first, block.first + most - 2});
      }
      ranges.push_back(block);
    }
    if (ranges.empty()) ranges.push_back({0, 0});
    return ranges;
  }

  /// A part of the columns with a part of the rows.
  struct Tabular {
    const ColumnBlock* block = nullptr;
    RowRange rows;
  };
  struct Float {
    std::vector<Tabular> tabulars;
    std::size_t lines = 0;
  };

  [[nodiscard]] std::string float_text(const Float& part, std::size_t number) const {
    const std::string name = is_wide_ ? "table*" : "table";
    std::string text = "% needs \\usepackage{booktabs}\n\\begin{" + name + "}[htbp]\n\\centering\n";
    if (is_small_) text += "\\footnotesize\n\\setlength{\\tabcolsep}{3pt}\n";
    text += "\\caption{" + latex_escaped(table_.title) + (number > 0 ? " (continued)" : "") +
            (table_.data.empty() ? "" : ". " + latex_escaped(table_.data)) + "}\n" +
            (number > 0 ? "" : "\\label{tab:" + label_of(table_.title) + "}\n") + "\\smallskip\n";
    for (std::size_t i = 0; i < part.tabulars.size(); ++i) {
      text += (i == 0 ? "" : "\\par\\medskip\n") + tabular_text(part.tabulars[i]);
    }
    const bool last = number + 1 == floats_.size();
    for (const std::string& note : last ? table_.notes : std::vector<std::string>{}) {
      text += "\n\\smallskip\n" + latex_escaped(note) + "\n";
    }
    return text + "\\end{" + name + "}\n";
  }

  [[nodiscard]] std::string tabular_text(const Tabular& part) const {
    const ColumnBlock& block = *part.block;
    // After \raggedright, `\\` ends a line and not a row.
    const bool has_long = std::any_of(block.begin(), block.end(),
                                      [](const LatexColumn& column) { return column.is_long; });
    const std::string end_of_row = has_long ? " \\tabularnewline\n" : " \\\\\n";
    std::string text = "\\begin{tabular}{l" + formats(block) + "}\n\\toprule\n";
    if (has_headings_) text += headings(block, end_of_row);
    text += latex_escaped(table_.corner);
    for (const LatexColumn& column : block) text += " & " + latex_escaped(column.name);
    text += end_of_row + "\\midrule\n";
    for (std::size_t i = part.rows.first; i < part.rows.end; ++i) {
      const TableRow& row = table_.rows[i];
      if (starts_block(i, part.rows)) {
        text += std::string(i == part.rows.first ? "" : "\\midrule\n") + "\\multicolumn{" +
                std::to_string(block.size() + 1) + "}{l}{\\textit{" + latex_escaped(row.block) +
                "}}" + end_of_row;
      } else if (row.summary && (i == 0 || !table_.rows[i - 1].summary)) {
        text += i == part.rows.first ? "" : "\\midrule\n";
      }
      text += row_text(row, block) + end_of_row;
    }
    return text + "\\bottomrule\n\\end{tabular}\n";
  }

  [[nodiscard]] static std::string row_text(const TableRow& row, const ColumnBlock& block) {
    std::string text = latex_escaped(row.label);
    for (const LatexColumn& column : block) {
      text += " & " + cell_text(row.cells[column.place], column.is_long);
    }
    return text;
  }

  [[nodiscard]] std::string formats(const ColumnBlock& block) const {
    double left = room_for_columns();
    std::size_t long_columns = 0;
    for (const LatexColumn& column : block) {
      long_columns += column.is_long ? 1 : 0;
      left -= measures().gap;
      if (!column.is_long) left -= measures().character * static_cast<double>(column.characters);
    }
    std::string text;
    for (const LatexColumn& column : block) {
      const double share = std::max(60.0, left / static_cast<double>(long_columns));
      text += column.is_long ? "p{" + fixed_text(std::floor(share), 0) + "pt}" : "r";
    }
    return text;
  }

  [[nodiscard]] std::string headings(const ColumnBlock& block,
                                     const std::string& end_of_row) const {
    std::string text, rules;
    std::size_t at = 2;
    for (const ColumnBlock& group : groups_of(block)) {
      const std::size_t end = at + group.size();
      text += " & \\multicolumn{" + std::to_string(group.size()) + "}{c}{" +
              latex_escaped(heading_of(group)) + "}";
      rules += "\\cmidrule(lr){" + std::to_string(at) + "-" + std::to_string(end - 1) + "}";
      at = end;
    }
    return text + end_of_row + rules + "\n";
  }

  [[nodiscard]] static std::string cell_text(const TableCell& cell, bool is_long) {
    const std::string text =
        is_long ? "\\raggedright " + breakable(cell.text) : latex_escaped(cell.text);
    if (cell.mark == Mark::kBest) return "\\textbf{" + text + "}";
    if (cell.mark == Mark::kSecond) return "\\underline{" + text + "}";
    return text;
  }

  const TextTable& table_;
  std::vector<LatexColumn> columns_;
  std::size_t label_characters_ = 0;
  bool has_headings_ = false;
  bool is_small_ = false;
  bool is_wide_ = false;  ///< Spans both columns of a two-column text.
  std::vector<ColumnBlock> blocks_;
  std::vector<Float> floats_;
};

}  // namespace

std::string to_latex(const TextTable& table) {
  return LatexTable(table).text();
}

}  // namespace raymoval
