// SPDX-License-Identifier: MIT
#include <algorithm>
#include <catch2/catch.hpp>

#include "benchmark/tables/text/text_table.h"

using namespace raymoval;
using Catch::Matchers::Contains;

namespace {

/// One row, `groups` methods with PR, RR and F1.
TextTable wide_table(std::size_t groups) {
  TextTable table{"wide", "sequence", {}, {{"town", {}, false}}, {"A note."}};
  for (std::size_t i = 0; i < groups; ++i) {
    table.groups.push_back({"method" + std::to_string(i), {"PR", "RR", "F1"}});
    for (const char* text : {"98.123", "91.000", "0.9443"}) {
      table.rows[0].cells.push_back({text, Mark::kNone});
    }
  }
  return table;
}

std::string latex_of_label(const std::string& label) {
  return to_latex({"t", "", {{"", {"x"}}}, {{label, {{"1", Mark::kNone}}, false}}, {}});
}

}  // namespace

TEST_CASE("LaTeX shows every character as it is") {
  CHECK_THAT(latex_of_label("a_b & 5% $#{}"), Contains("\na\\_b \\& 5\\% \\$\\#\\{\\} & 1 "));
  CHECK_THAT(latex_of_label("\\~^<>|`"),
             Contains("\\textbackslash{}\\textasciitilde{}\\textasciicircum{}\\textless{}"
                      "\\textgreater{}\\textbar{}\\`{}"));
  CHECK_THAT(latex_of_label("--set"), Contains("-{}-set"));
  CHECK_THAT(latex_of_label("\xC3\xA9\xE2\x86\x92z\x01"), Contains("\n\xC3\xA9?z  & 1"));
}

TEST_CASE("The caption has the title and the data, and one label is made of the title") {
  TextTable table = wide_table(1);
  table.title = "Accuracy by protocol a_b:2*";
  table.data = "On 05 (10 scans).";
  CHECK_THAT(to_latex(table),
             Contains("\\caption{Accuracy by protocol a\\_b:2*. On 05 (10 scans).}\n"
                      "\\label{tab:accuracy-by-protocol-a-b-2*}\n"));
}

TEST_CASE("A label cannot be taken for an option of the row before it") {
  CHECK_THAT(latex_of_label("[2] x"), Contains("\n{}[2] x & 1"));
  CHECK_THAT(latex_of_label("*"), Contains("\n{}* & 1"));
}

TEST_CASE(
    "Blanks before a bracket do not make it an option either, and no control character is left") {
  CHECK_THAT(latex_of_label(" [2pt] x"), Contains("\n{} [2pt] x & 1 "));
  CHECK_THAT(latex_of_label(" \t*x"), Contains("\n{}  *x & 1 "));
  for (const char* label : {"a\x7f"
                            "b",
                            "a\x1b[2Jb", "a\x07\rb", "\xc2\x9b", "\xe2\x80\xae"}) {
    const std::string latex = latex_of_label(label);
    CHECK(std::none_of(latex.begin(), latex.end(), [](unsigned char c) {
      return (c < 0x20 && c != '\n') || c == 0x7F || c == 0x9B || c == 0xAE;
    }));
  }
}

TEST_CASE("Markdown of any text is text") {
  const TextTable table{"[t](http:x)",
                        "<b>",
                        {{"![g](x)", {"`c`"}}},
                        {{"\x1b[2J a|b", {{"&#x202e; \\", Mark::kBest}}, false}},
                        {"[n](javascript:x) \xe2\x80\xae \x07"}};
  const std::string text = to_markdown(table);
  for (const char* live : {"\x1b", "\x07", "\xe2\x80\xae", " [t]", "![g]", " `c", " &#", "\n[n]"}) {
    INFO(text);
    CHECK(text.find(live) == std::string::npos);
  }
  CHECK_THAT(text, Contains("\\[t](http:x)") && Contains("a\\|b") && Contains("\\&#x202e; \\\\"));
}

TEST_CASE("A wide table spans two columns, and each is made to fit the page") {
  CHECK_THAT(to_latex(wide_table(1)), Contains("\\begin{table}[htbp]") &&
                                          Contains("\\end{table}\n") && Contains("\\resizebox{"));
  const std::string twelve = to_latex(wide_table(12));
  CHECK_THAT(twelve, Contains("\\begin{table*}[htbp]") && Contains("\\end{table*}\n"));
  CHECK_THAT(twelve, Contains("\\multicolumn{3}{c}{method11} \\tabularnewline\n"));
  CHECK_THAT(twelve, Contains("}}\n\n\\smallskip\nA note.\n"));
}

TEST_CASE("Blocks have a heading in italics and a rule between them") {
  TextTable table{"t", "method", {{"", {"PR"}}}, {}, {}};
  for (const char* block : {"a_1", "b"}) {
    for (const char* label : {"x", "y"}) table.rows.push_back({label, {{"1"}}, false, block});
  }
  const std::string latex = to_latex(table);
  CHECK_THAT(latex,
             Contains("\\midrule\n\\multicolumn{2}{l}{\\textit{a\\_1}} \\tabularnewline\nx & 1"));
  CHECK_THAT(latex,
             Contains("y & 1 \\tabularnewline\n\\midrule\n\\multicolumn{2}{l}{\\textit{b}}"));
}

TEST_CASE("A long text is broken into lines, also behind slashes") {
  const std::string text = "no/blank/in/this/path/of/more/than/one/line";
  const TextTable table{"t", "cell", {{"", {"reason"}}}, {{"x", {{text, Mark::kNone}}, false}}, {}};
  const std::string latex = to_latex(table);
  CHECK_THAT(latex, Contains("{lp{") && Contains("\\raggedright no/\\allowbreak{}blank") &&
                        Contains("\\tabularnewline"));
}
