// SPDX-License-Identifier: MIT
#include "benchmark/tables/comparison_files.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "benchmark/result/cell.h"
#include "benchmark/result/sealed_json.h"
#include "benchmark/tables/text/text_table.h"
#include "core/error.h"
#include "core/text.h"
#include "core/utf8.h"

namespace raymoval {
namespace {

bool only_in_run(const ScoreComparison& score) {
  return score.change == Change::kMoved && score.rates.empty() && !score.reasons.empty();
}

/// All that moved in a score, in words.
std::vector<std::string> moved_parts(const ScoreComparison& score) {
  std::vector<std::string> parts = score.reasons;
  for (const RateChange& rate : score.rates) {
    if (rate.change != Change::kSame) parts.push_back(change_text(rate));
  }
  for (const CountChange& count : score.counts) parts.push_back(change_text(count));
  return parts;
}

std::vector<std::string> sequences_of(const Comparison& comparison) {
  std::vector<std::string> names;
  for (const ScoreComparison& score : comparison.scores) {
    if (std::find(names.begin(), names.end(), score.sequence) == names.end()) {
      names.push_back(score.sequence);
    }
  }
  return names;
}

// Markdown.

/// Text in a cell of a table.
std::string in_table(const std::string& text) {
  std::string escaped;
  for (const char c : printable_text(text)) {
    if (std::string_view("|\\`*_<[&").find(c) != std::string_view::npos) escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string markdown_row(const std::vector<std::string>& cells) {
  std::string row = "|";
  for (const std::string& cell : cells) row += " " + in_table(cell) + " |";
  return row + "\n";
}

std::string comparison_markdown(const Comparison& comparison, const ComparisonSubject& subject) {
  std::string text = "**" + in_table(subject.run) + " against " + in_table(subject.reference) +
                     ": " + comparison.verdict_words() + "** (" +
                     std::to_string(comparison.same_cells) + " of " +
                     std::to_string(comparison.cells) + " cells are the same)\n";
  std::string rows;
  for (const ScoreComparison& score : comparison.scores) {
    if (score.change == Change::kSame) continue;
    std::vector<std::string> rates = score.reasons;
    for (const RateChange& rate : score.rates) {
      if (rate.change != Change::kSame) rates.push_back(change_text(rate));
    }
    if (rates.empty()) rates = moved_parts(score);
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
    if (line.sequence.empty()) more += "- " + in_table(line.text) + "\n";
  }
  for (const std::string& line : comparison.times) more += "- time: " + in_table(line) + "\n";
  return text + (more.empty() ? "" : "\n" + more);
}

// JUnit.

struct TestCase {
  std::string name;
  Change change = Change::kSame;
  bool skipped = false;
  std::string text;  ///< What went wrong, or moved.
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
    std::vector<std::string> parts = moved_parts(score);
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

/// What is wrong with a run as a whole: one test that fails for each problem.
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

// JSON.

using nlohmann::ordered_json;

template <class Value>
ordered_json value_or_null(const std::optional<Value>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

/// A list with what `to_record` makes of each item.
template <class Item, class Function>
ordered_json list_of(const std::vector<Item>& items, Function to_record) {
  ordered_json list = ordered_json::array();
  for (const Item& item : items) list.push_back(to_record(item));
  return list;
}

ordered_json options_record(const ComparisonOptions& options) {
  ordered_json tolerances = ordered_json::object();
  for (const auto& [rate, tolerance] : options.tolerances) tolerances[rate] = tolerance;
  ordered_json across = ordered_json::array();
  if (options.across_parameters) across.push_back("parameters");
  if (options.across_version) across.push_back("version");
  return {{"tolerances", std::move(tolerances)},
          {"time_band", value_or_null(options.time_band)},
          {"across", std::move(across)}};
}

ordered_json rate_json(const RateChange& rate) {
  return {{"name", rate.name},
          {"reference", value_or_null(rate.before)},
          {"run", value_or_null(rate.after)},
          {"tolerance", value_or_null(rate.tolerance)},
          {"verdict", change_name(rate.change)}};
}

ordered_json count_json(const CountChange& count) {
  return {{"name", count.name},
          {"reference", value_or_null(count.before)},
          {"run", value_or_null(count.after)}};
}

ordered_json score_json(const ScoreComparison& score) {
  return {
      {"sequence", score.sequence},
      {"name", score.name},
      {"protocol", score.protocol.empty() ? ordered_json(nullptr) : ordered_json(score.protocol)},
      {"verdict", change_name(score.change)},
      {"reasons", score.reasons},
      {"across", score.across},
      {"rates", list_of(score.rates, rate_json)},
      {"counts", list_of(score.counts, count_json)}};
}

ordered_json time_json(const TimeChange& time) {
  const bool both = time.change != Change::kIncomparable;
  return {{"sequence", time.sequence},
          {"name", time.name},
          {"reference", value_or_null(time.before)},
          {"run", value_or_null(time.after)},
          {"ratio", both ? ordered_json(time.ratio()) : ordered_json(nullptr)},
          {"verdict", change_name(time.change)}};
}

/// The lines that are about the run as a whole.
ordered_json problem_records(const Comparison& comparison) {
  ordered_json problems = ordered_json::array();
  for (const ComparisonLine& line : comparison.lines) {
    if (!line.sequence.empty()) continue;
    problems.push_back({{"verdict", change_name(line.change)}, {"text", line.text}});
  }
  return problems;
}

ordered_json comparison_record(const Comparison& comparison, const ComparisonSubject& subject) {
  return {{"schema_version", kSchemaVersion},
          {"run", subject.run},
          {"reference", subject.reference},
          {"verdict", comparison.verdict_words()},
          {"exit_code", static_cast<int>(comparison.verdict())},
          {"cells", comparison.cells},
          {"same_cells", comparison.same_cells},
          {"options", options_record(subject.options)},
          {"problems", problem_records(comparison)},
          {"scores", list_of(comparison.scores, score_json)},
          {"times", list_of(comparison.time_changes, time_json)}};
}

}  // namespace

const std::vector<std::string>& comparison_formats() {
  static const std::vector<std::string> formats = {"text", "md", "junit", "json"};
  return formats;
}

std::string comparison_in(const std::string& format, const Comparison& comparison,
                          const ComparisonSubject& subject) {
  if (format == "text") return comparison_text(comparison);
  if (format == "md") return comparison_markdown(comparison, subject);
  if (format == "junit") return comparison_junit(comparison);
  if (format == "json") return json_text(comparison_record(comparison, subject));
  throw UsageError("--format " + format + ": is no way to write a comparison." +
                   suggestion(format, comparison_formats()));
}

}  // namespace raymoval
