// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raymoval {

enum class Mark { kNone, kBest, kSecond };

struct TableCell {
  std::string text;
  Mark mark = Mark::kNone;
  /// The displayed number; no value in a cell whose number is not compared.
  std::optional<double> value = {};
};

/// A cell with `number`, rounded to `decimals` digits behind the point.
TableCell number_cell(double number, int decimals);
/// The same, or a cell with the text `none` if there is no number.
TableCell number_or(const std::optional<double>& number, int decimals, const char* none);

struct TableRow {
  std::string label;
  std::vector<TableCell> cells;
  bool summary = false;    ///< Set apart from the rows above it.
  std::string block = {};  ///< Heading of the row's block, such as a sequence.
};

/// Columns that share a heading, such as PR, RR and F1 of a method.
struct TableGroup {
  std::string heading;
  std::vector<std::string> columns;
};

/// A table independent of how it is written.
struct TextTable {
  std::string title;
  std::string corner;  ///< Heading of the first column.
  std::vector<TableGroup> groups = {};
  std::vector<TableRow> rows = {};  ///< As many cells as all groups have columns.
  std::vector<std::string> notes = {};
  std::string data = {};  ///< The data of the measurement, for the caption of LaTeX.
};

/// Rows [first, end) of a table.
struct RowRange {
  std::size_t first = 0, end = 0;
};

/// The rows of each block, in their order.
std::vector<RowRange> blocks_of(const TextTable& table);

/// Marks the best and the second best cell by value; cells that are displayed equally get the same
/// mark. If fewer than two cells have a value, none is marked.
void mark_best(const std::vector<TableCell*>& cells, bool higher_is_better);
/// The same in column `place` of the rows that are no summary, of all of them or of some.
void mark_best(TextTable& table, std::size_t place, bool higher_is_better);
void mark_best(TextTable& table, std::size_t place, bool higher_is_better, const RowRange& rows);

/// `text` with blanks behind it up to `width` characters, or in front of it.
std::string padded(const std::string& text, std::size_t width);
std::string padded_left(const std::string& text, std::size_t width);

/// At most `most` characters: "..." replaces the middle of a longer text.
std::string shortened_middle(const std::string& text, std::size_t most);

/// At most `most` characters: "..." replaces the end of a longer text.
std::string shortened_end(const std::string& text, std::size_t most);

/// Lines of at most `most` characters, broken between words, each with its end of line.
std::string wrapped(const std::string& text, std::size_t most);

/// `text` escaped for Markdown: no part of it is read as a table, tag, link, picture, code or
/// character entity. Control and invisible characters are treated as in `printable_text`.
std::string markdown_text(const std::string& text, std::string_view special = "|<*[`\\&");

/// Maximum width of text for a terminal.
inline constexpr std::size_t kTerminalWidth = 100;

/// Columns aligned by blanks, for a terminal: no title, no blocks, the best value with a '*'.
std::string to_plain(const TextTable& table);

/// Markdown with aligned columns: best bold, second underlined; each block has a heading and a
/// table of its own, all of the same widths.
std::string to_markdown(const TextTable& table);

/// LaTeX that needs the packages booktabs and graphicx: everything escaped, best bold, second
/// underlined, each block below a heading. A table that is too wide for a column of a two-column
/// article becomes a `table*`, which spans both columns. A table that is wider than the text or
/// higher than a page is shrunk. Long texts are broken into lines. The caption has the title and
/// the data, and the label is made of the title: "tab:accuracy-by-protocol-erasor". Characters
/// beyond Latin-1, which LaTeX does not support without packages, become question marks.
std::string to_latex(const TextTable& table);

}  // namespace raymoval
