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

/// LaTeX with booktabs, everything escaped: best bold, second underlined.
std::string to_latex(const TextTable& table);

}  // namespace raymoval
