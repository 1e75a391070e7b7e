// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "benchmark/result/result_fields.h"
#include "benchmark/result/run_record_json.h"
#include "benchmark/tables/cell_line.h"
#include "benchmark/tables/run_summary.h"
#include "benchmark/tables/tables.h"
#include "core/error.h"
#include "core/files/files.h"
#include "core/text.h"
#include "eval/protocol_registry.h"
#include "tests/benchmark/scored_cell.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;
using Catch::Matchers::Contains;
using test::failed_cell, test::timed_cell;

namespace {

/// Methods x, y and z on a KITTI segment and on a simulated town; z failed in town.
RunResults three_by_two() {
  RunResults results;
  results.name = "test";
  results.sequences = {"kitti-05", "town"};
  results.methods = {"x", "y", "z"};
  results.protocols = {"erasor"};
  results.cells = {timed_cell("kitti-05", "x", 90, 60, 0.72, 0.002),
                   timed_cell("town", "x", 70, 100, 0.8236, 0.002),
                   timed_cell("kitti-05", "y", 80, 80, 0.8, 0.001),
                   timed_cell("town", "y", 50, 50, 0.5, 0.003),
                   timed_cell("kitti-05", "z", 99, 20, 0.3328, 0.5),
                   failed_cell("town", "z", "did not finish within 600 s")};
  results.times = {{"x", 100, 0.2, 0.0, {}}, {"y", 100, 0.2, 0.0, {}}};
  return results;
}

std::vector<std::string> labels_of(const TextTable& table, const std::string& block) {
  std::vector<std::string> labels;
  for (const TableRow& row : table.rows) {
    if (row.block == block) labels.push_back(row.label);
  }
  return labels;
}

std::size_t widest_line(const std::string& text) {
  std::size_t width = 0;
  for (const std::string_view line : split(text, '\n')) width = std::max(width, line.size());
  return width;
}

}  // namespace

TEST_CASE("Rows are methods, columns rates, with a block for each sequence") {
  TableOptions options;
  options.rates = {"PR", "RR", "F1", kTimeRate};
  const std::vector<TextTable> tables = accuracy_tables(three_by_two(), "erasor", options);
  REQUIRE(tables.size() == 2);
  const TextTable& table = tables[0];
  CHECK(table.groups.size() == 1);
  // Without being asked there is nothing in it that differs from run to run.
  CHECK(accuracy_tables(three_by_two(), "erasor", {})[0].groups[0].columns ==
        std::vector<std::string>{"PR", "RR", "F1"});
  CHECK(table.groups[0].columns == std::vector<std::string>{"PR", "RR", "F1", "ms per scan"});
  REQUIRE(table.rows.size() == 6);
  CHECK(labels_of(table, "kitti-05") == std::vector<std::string>{"x", "y", "z"});
  // PR 99 before 90; F1 0.8 before 0.72; the least time is the best.
  CHECK(table.rows[2].cells[0].mark == Mark::kBest);
  CHECK(table.rows[0].cells[0].mark == Mark::kSecond);
  CHECK(table.rows[1].cells[2].mark == Mark::kBest);
  CHECK(table.rows[1].cells[3].mark == Mark::kBest);
  CHECK(table.rows[0].cells[3].mark == Mark::kSecond);
  CHECK(table.rows[5].cells[0].text == "timeout");
  const std::string markdown = to_markdown(table);
  CHECK_THAT(markdown, Contains("\n### kitti-05\n\n| method |") && Contains("\n### town\n"));
  CHECK(widest_line(markdown) <= 100);
}

TEST_CASE("The means name both averages of F1 and how many sequences they are over") {
  const TextTable means = accuracy_tables(three_by_two(), "erasor", {}).at(1);
  CHECK(means.groups[0].columns ==
        std::vector<std::string>{"mean_PR", "mean_RR", "mean_F1", "F1_of_means"});
  // x: PR (90 + 70) / 2, RR (60 + 100) / 2, F1 (0.72 + 0.8236) / 2; F1 of 80 and 80 is 0.8.
  CHECK(means.rows[0].cells[0].text == "80.000");
  CHECK(means.rows[0].cells[2].text == "0.7718");
  CHECK(means.rows[0].cells[3].text == "0.8000");
  CHECK(means.rows[2].cells[0].text == "99.000 (1/2)");
  CHECK(means.rows[2].cells[3].text == "0.3328 (1/2)");
}

TEST_CASE("Papers' rows stand in the blocks of sequences that they have, and nowhere else") {
  TableOptions options;
  options.outside = {
      {"paper", "erasor", {{"05", {{"PR", 88.0}, {"RR", 90.0}, {"F1", 0.89}}, "kitti-05"}}}};
  const std::vector<TextTable> tables = accuracy_tables(three_by_two(), "erasor", options);
  CHECK(labels_of(tables[0], "kitti-05") == std::vector<std::string>{"x", "y", "z", "paper"});
  CHECK(labels_of(tables[0], "town") == std::vector<std::string>{"x", "y", "z"});
  CHECK(tables[0].rows[3].cells[2].text == "0.890");
  CHECK(tables[1].rows.size() == 3);  // A mean over other sequences is not set beside ours.
}

TEST_CASE("Rates, decimals and order are as asked for") {
  TableOptions options;
  options.rates = {"F1", "PR"};
  options.sort = "F1";
  parse_decimals("1", options);
  parse_decimals("F1=3", options);
  const TextTable table = accuracy_tables(three_by_two(), "erasor", options).at(0);
  CHECK(table.groups[0].columns == std::vector<std::string>{"F1", "PR"});
  CHECK(labels_of(table, "kitti-05") == std::vector<std::string>{"y", "x", "z"});
  CHECK(labels_of(table, "town") == std::vector<std::string>{"x", "y", "z"});  // z has no F1 there.
  CHECK(table.rows[0].cells[0].text == "0.800");
  CHECK(table.rows[0].cells[1].text == "80.0");
  options.sort = kTimeRate;
  options.rates = {"F1", kTimeRate};
  CHECK(labels_of(accuracy_tables(three_by_two(), "erasor", options).at(0), "town") ==
        std::vector<std::string>{"x", "y", "z"});  // 2 ms before 3 ms.
  options.sort = "F2";
  CHECK_THROWS_WITH(check_rates(options, three_by_two()),
                    Contains("--sort F2") && Contains("'F1'"));
  options = {};
  options.rates = {"PRR"};
  CHECK_THROWS_WITH(check_rates(options, three_by_two()), Contains("--rates PRR"));
  CHECK_THROWS_WITH(parse_decimals("F1=x", options), Contains("--decimals F1=x"));
  CHECK_THROWS_WITH(parse_decimals("10", options), Contains("0 to 9"));
}

TEST_CASE("Chosen cells leave their sequences and methods only") {
  ResultsRecord whole;
  whole.run.sequences = {{DataRecord{"a"}}, {DataRecord{"b"}}};
  whole.run.methods = {{"x", "x", "1"}, {"y", "y", "1"}};
  whole.cells = {{"a", "x", ""}, {"a", "y", ""}, {"b", "x", ""}};
  whole.missing = {"b / y"};
  ResultsRecord chosen = whole;
  choose_cells(chosen, {});
  CHECK(to_json(chosen) == to_json(whole));
  choose_cells(chosen, {"a/x"});
  CHECK(chosen.cells.size() == 1);
  CHECK(names_of(chosen.run.sequences) == std::vector<std::string>{"a"});
  CHECK(names_of(chosen.run.methods) == std::vector<std::string>{"x"});
  CHECK(chosen.missing.empty());
  CHECK_THROWS_WITH(choose_cells(whole, {"c"}), Contains("matches no cell of this run"));
}

TEST_CASE("The end of a run fits a screen for ten methods") {
  RunResults results = three_by_two();
  results.methods.clear();
  results.cells.erase(results.cells.begin(), results.cells.end() - 1);
  results.protocols = {"erasor", "dynamicmap"};
  for (int i = 0; i < 10; ++i) {
    const std::string cell = "a_method_with_a_rather_long_name:variant" + std::to_string(i);
    results.methods.push_back(cell);
    for (const std::string& sequence : results.sequences) {
      results.cells.push_back(timed_cell(sequence, cell, 90 + i, 60, 0.7 + 0.01 * i, 0.01));
      results.cells.back().scores.push_back(test::score_by(
          "dynamicmap", {{"SA", 99.0}, {"DA", 98.0}, {"AA", 98.5}, {"HA", 98.4975}}));
    }
  }
  const std::string text = run_summary(results, "out/run");
  CHECK(widest_line(text) <= 100);
  CHECK(split(text, '\n').size() <= 40);
  // Best first.
  CHECK(text.find("variant9") < text.find("variant8"));
  CHECK_THAT(text, Contains("0.7900*") && Contains("timeout: town / z: did not finish") &&
                       Contains("raymoval table out/run"));
}

TEST_CASE("The log line of a cell has its F1 and time first and no rates of secondary kinds") {
  const auto cell = [](const std::string& sequence, const std::string& name, double f1) {
    Cell made{sequence, name, ""};
    const std::vector<Rate> rates = {
        {"PR", 100.0}, {"RR", 9.5}, {"F1", f1}, {"PR_no_truck", 1.0}, {"F1_no_truck", 0.5}};
    made.scores = {{{}, {}, rates}, {{}, {}, {{"SA", {}}, {"DA", 1.0}, {"AA", 2.0}, {"HA", 99.5}}}};
    made.measured.emplace().mean_seconds = 0.0123;
    return made;
  };
  const CellLines lines({"a", "town"}, {"x", "longer:variant"}, 52);
  const std::string first = lines.line(3, cell("a", "x", 0.25));
  CHECK(first ==
        "[ 3/52] a     x               F1 0.2500     12.3 ms  PR 100.000  RR   9.500  HA  99.500");
  const std::string second = lines.line(12, cell("town", "longer:variant", 1.0), true);
  CHECK(second.substr(0, first.size()).find("F1") == first.find("F1"));
  CHECK(second.ends_with("  (kept)"));
  const std::string name(60, 'n'), sequence(60, 's');
  const CellLines wide({sequence}, {name}, 1000);
  CHECK(wide.line(7, cell(sequence, name, 0.5)).size() <= 100);
  Cell failed = cell("a", "x", 0.0);
  failed.fail(CellStatus::kFailed, std::string(200, 'r'));
  CHECK(lines.line(1, failed).size() == 100);
  CHECK_THAT(lines.line(1, failed), Contains("failed: rrr") && Catch::Matchers::EndsWith("..."));
}

TEST_CASE("A rate is known by its name, a secondary one by the name it begins with") {
  CHECK(rate_spec("F1").unit == RateUnit::kFraction);
  CHECK(rate_spec("F1").role == RateRole::kHeadline);
  CHECK(rate_spec("F1_no_truck").decimals == 4);
  CHECK(rate_spec("F1_no_truck").role == RateRole::kSecondary);
  CHECK(rate_spec("anything").role == RateRole::kSecondary);
  CHECK(rate_text("F1_no_truck", 0.5) == "0.5000");
}
