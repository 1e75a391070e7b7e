// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>
#include <string_view>

#include "benchmark/tables/text/text_table.h"
#include "core/text.h"
#include "core/utf8.h"

namespace raymoval {
namespace {

constexpr std::size_t kNarrow = 40;    ///< Characters that fit a column of a two-column article.
constexpr std::size_t kLongText = 26;  ///< Characters; columns with more are broken into lines.

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

/// After \raggedright, two backslashes end a line and not a row.
constexpr const char* kEndOfRow = " \\tabularnewline\n";

std::string cell_text(const TableCell& cell, bool is_long) {
  const std::string text =
      is_long ? "\\raggedright " + breakable(cell.text) : latex_escaped(cell.text);
  if (cell.mark == Mark::kBest) return "\\textbf{" + text + "}";
  if (cell.mark == Mark::kSecond) return "\\underline{" + text + "}";
  return text;
}

/// The row of the groups' headings with its rules; empty if no group has one.
std::string headings(const TextTable& table) {
  std::string text, rules;
  std::size_t at = 2;
  bool any = false;
  for (const TableGroup& group : table.groups) {
    const std::size_t end = at + group.columns.size();
    any = any || !group.heading.empty();
    text += " & \\multicolumn{" + std::to_string(end - at) + "}{c}{" +
            latex_escaped(group.heading) + "}";
    rules += "\\cmidrule(lr){" + std::to_string(at) + "-" + std::to_string(end - 1) + "}";
    at = end;
  }
  return any ? text + kEndOfRow + rules + "\n" : "";
}

class LatexTable {
 public:
  explicit LatexTable(const TextTable& table) : table_(table) {
    characters_ = character_count(table.corner);
    for (const TableRow& row : table.rows) {
      characters_ = std::max(characters_, character_count(row.label));
    }
    for (const TableGroup& group : table.groups) {
      for (const std::string& name : group.columns) {
        std::size_t characters = character_count(name);
        for (const TableRow& row : table.rows) {
          characters = std::max(characters, character_count(row.cells[names_.size()].text));
        }
        names_.push_back(name);
        long_.push_back(characters > kLongText);
        characters_ += characters + 2;
      }
    }
  }

  [[nodiscard]] std::string text() const {
    const std::string name = characters_ > kNarrow ? "table*" : "table";
    std::string text = "% needs \\usepackage{booktabs,graphicx}\n\\begin{" + name +
                       "}[htbp]\n\\centering\n\\caption{" + latex_escaped(table_.title) +
                       (table_.data.empty() ? "" : ". " + latex_escaped(table_.data)) +
                       "}\n\\label{tab:" + label_of(table_.title) + "}\n\\smallskip\n" + kFit +
                       tabular() + "}}\n";
    for (const std::string& note : table_.notes) {
      text += "\n\\smallskip\n" + latex_escaped(note) + "\n";
    }
    return text + "\\end{" + name + "}\n";
  }

 private:
  /// Shrinks a table that is wider than the text or higher than a page.
  static constexpr const char* kFit =
      "\\resizebox{\\ifdim\\width>\\linewidth\\linewidth\\else\\width\\fi}{!}{%\n"
      "\\resizebox*{!}{\\ifdim\\totalheight>0.8\\textheight0.8\\textheight\\else\\totalheight\\fi}{"
      "%\n";

  [[nodiscard]] std::string tabular() const {
    std::string text = "\\begin{tabular}{l";
    for (const bool is_long : long_) text += is_long ? "p{60mm}" : "r";
    text += "}\n\\toprule\n" + headings(table_) + latex_escaped(table_.corner);
    for (const std::string& name : names_) text += " & " + latex_escaped(name);
    text += std::string(kEndOfRow) + "\\midrule\n";
    for (std::size_t i = 0; i < table_.rows.size(); ++i) {
      const TableRow& row = table_.rows[i];
      const TableRow* last = i == 0 ? nullptr : &table_.rows[i - 1];
      const bool starts = !row.block.empty() && (last == nullptr || last->block != row.block);
      const bool summary = row.summary && last != nullptr && !last->summary;
      if (last != nullptr && (starts || summary)) text += "\\midrule\n";
      if (starts) {
        text += "\\multicolumn{" + std::to_string(names_.size() + 1) + "}{l}{\\textit{" +
                latex_escaped(row.block) + "}}" + kEndOfRow;
      }
      text += latex_escaped(row.label);
      for (std::size_t k = 0; k < row.cells.size(); ++k) {
        text += " & " + cell_text(row.cells[k], long_[k]);
      }
      text += kEndOfRow;
    }
    return text + "\\bottomrule\n\\end{tabular}%\n";
  }

  const TextTable& table_;
  std::vector<std::string> names_;  ///< Of the columns.
  std::vector<bool> long_;          ///< Whether their texts are broken into lines.
  std::size_t characters_ = 0;      ///< Of the widest row.
};

}  // namespace

std::string to_latex(const TextTable& table) {
  return LatexTable(table).text();
}

}  // namespace raymoval
