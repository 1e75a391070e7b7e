// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace raymoval {

enum class Mark { kNone, kBest, kSecond };

struct TableCell {
  std::string text;
  Mark mark = Mark::kNone;
};

struct TableRow {
  std::string label;
  std::vector<TableCell> cells;
  bool summary = false;  ///< Set apart from the rows above it.
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
  std::vector<TableGroup> groups;
  std::vector<TableRow> rows;  ///< As many cells as all groups have columns.
  std::vector<std::string> notes;
};

/// Markdown with aligned columns: best bold, second underlined.
std::string to_markdown(const TextTable& table);

/// LaTeX that needs the package booktabs and nothing else: everything escaped, best bold, second
/// underlined. What is too wide for the text of an article (345 pt) is set smaller, then cut into
/// several tables, one below the other, then into several floats; long texts are broken into lines.
/// Characters beyond Latin-1, which LaTeX does not know by itself, become question marks.
std::string to_latex(const TextTable& table);

}  // namespace raymoval
