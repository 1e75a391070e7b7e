// SPDX-License-Identifier: MIT
#include "benchmark/tables/comparison_files.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "benchmark/tables/table_options.h"
#include "core/error.h"
#include "core/text.h"
#include "core/utf8.h"

namespace raymoval {

namespace {

bool only_in_run(const ScoreComparison& score) {
  return score.change == Change::kMoved && score.rates.empty() && !score.reasons.empty();
}

/// The changes of a score, in words.
std::vector<std::string> moved_parts(const ScoreComparison& score, bool with_counts) {
  std::vector<std::string> parts = score.reasons;
  for (const RateChange& rate : score.rates) {
    if (rate.change != Change::kSame) parts.push_back(change_text(rate));
  }
  for (const CountChange& count : with_counts ? score.counts : std::vector<CountChange>()) {
    parts.push_back(change_text(count));
  }
  return parts;
}

std::vector<std::string> sequences_of(const Comparison& comparison) {
  std::vector<std::string> names;
  for (const ScoreComparison& score : comparison.scores) add_once(names, score.sequence);
  return names;
}

// Markdown.

/// Text in which '_' is escaped too.
std::string markdown_word(const std::string& text) {
  return markdown_text(text, "|<*[`\\&_");
}

std::string markdown_row(const std::vector<std::string>& cells) {
  std::string row = "|";
  for (const std::string& cell : cells) row += " " + markdown_word(cell) + " |";
  return row + "\n";
}

std::string comparison_markdown(const Comparison& comparison, const ComparisonSubject& subject) {
  std::string text = "**" + markdown_word(subject.run) + " against " +
                     markdown_word(subject.reference) + ": " + comparison.verdict_words() + "** (" +
                     std::to_string(comparison.same_cells) + " of " +
                     std::to_string(comparison.cells) + " cells are the same)\n";
  std::string rows;
  for (const ScoreComparison& score : comparison.scores) {
    if (score.change == Change::kSame) continue;
    std::vector<std::string> rates = moved_parts(score, false);
    if (rates.empty()) rates = moved_parts(score, true);
    rows += markdown_row({change_name(score.change), score.sequence, score.name, score.protocol,
                          join(rates, "; "), join(score.across, "; ")});
  }
  if (!rows.empty()) {
    text +=
        "\n| verdict | sequence | method | protocol | what | across "
        "|\n|---|---|---|---|---|---|\n" +
        rows;
  }
  std::string more;
  for (const ComparisonLine& line : comparison.lines) {
    if (line.sequence.empty()) more += "- " + markdown_word(line.text) + "\n";
  }
  for (const std::string& line : comparison.times) more += "- time: " + markdown_word(line) + "\n";
  return text + (more.empty() ? "" : "\n" + more);
}

// JUnit.

struct TestCase {
  std::string name;
  Change change = Change::kSame;
  bool skipped = false;
  std::string text;  ///< The problem, or the change.
};

std::string attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + "=\"" + xml_escaped(value) + "\"";
}

std::string test_case_xml(const std::string& suite, const TestCase& test) {
  std::string xml = "    <testcase" + attribute("classname", suite) + attribute("name", test.name);
  if (test.text.empty()) return xml + "/>\n";
  xml += ">\n      ";
  if (test.change == Change::kIncomparable) {
    xml += "<error" + attribute("type", "not comparable") + attribute("message", test.text) + "/>";
  } else if (test.change == Change::kWorse) {
    xml += "<failure" + attribute("type", "worse") + attribute("message", test.text) + "/>";
  } else if (test.skipped) {
    xml += "<skipped" + attribute("message", test.text) + "/>";
  } else {
    xml += "<system-out>" + xml_escaped(std::string(change_name(test.change)) + ": " + test.text) +
           "</system-out>";
  }
  return xml + "\n    </testcase>\n";
}

std::string totals(const std::vector<TestCase>& tests) {
  const auto count = [&](auto is) {
    return std::to_string(std::count_if(tests.begin(), tests.end(), is));
  };
  return attribute("tests", std::to_string(tests.size())) +
         attribute("failures", count([](auto& test) { return test.change == Change::kWorse; })) +
         attribute("errors",
                   count([](auto& test) { return test.change == Change::kIncomparable; })) +
         attribute("skipped", count([](auto& test) { return test.skipped; }));
}

std::vector<TestCase> sequence_tests(const Comparison& comparison, const std::string& sequence) {
  std::vector<TestCase> tests;
  for (const ScoreComparison& score : comparison.scores) {
    if (score.sequence != sequence) continue;
    std::vector<std::string> parts = moved_parts(score, true);
    if (score.change == Change::kSame) parts.clear();
    parts.insert(parts.end(), score.across.begin(), score.across.end());
    tests.push_back({score.name + (score.protocol.empty() ? "" : ", " + score.protocol),
                     score.change, only_in_run(score), join(parts, "; ")});
  }
  for (const TimeChange& time : comparison.time_changes) {
    if (time.sequence != sequence) continue;
    tests.push_back({time.name + ", time", time.change, false, change_text(time)});
  }
  return tests;
}

/// The problems of a run as a whole: a failed test for each.
std::vector<TestCase> run_tests(const Comparison& comparison) {
  std::vector<TestCase> tests;
  for (const ComparisonLine& line : comparison.lines) {
    if (!line.sequence.empty()) continue;
    tests.push_back({line.change == Change::kWorse ? "controls" : "comparability", line.change,
                     false, line.text});
  }
  if (tests.empty()) tests.push_back({"controls", Change::kSame, false, ""});
  return tests;
}

std::string comparison_junit(const Comparison& comparison) {
  std::vector<std::pair<std::string, std::vector<TestCase>>> suites;
  suites.emplace_back("run", run_tests(comparison));
  std::vector<TestCase> all = suites.back().second;
  for (const std::string& sequence : sequences_of(comparison)) {
    suites.emplace_back(sequence, sequence_tests(comparison, sequence));
    all.insert(all.end(), suites.back().second.begin(), suites.back().second.end());
  }
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites" +
                    attribute("name", "raymoval compare") + totals(all) + ">\n";
  for (const auto& [name, tests] : suites) {
    xml += "  <testsuite" + attribute("name", name) + totals(tests) + ">\n";
    for (const TestCase& test : tests) xml += test_case_xml(name, test);
    xml += "  </testsuite>\n";
  }
  return xml + "</testsuites>\n";
}

}  // namespace

const std::vector<std::string>& comparison_formats() {
  static const std::vector<std::string> formats = {"text", "md", "junit"};
  return formats;
}

std::string comparison_in(const std::string& format, const Comparison& comparison,
                          const ComparisonSubject& subject) {
  if (format == "text") return comparison_text(comparison);
  if (format == "md") return comparison_markdown(comparison, subject);
  if (format == "junit") return comparison_junit(comparison);
  throw UsageError("--format " + format + ": is not a format of a comparison." +
                   suggestion(format, comparison_formats()));
}

}  // namespace raymoval
