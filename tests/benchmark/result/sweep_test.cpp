// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include <algorithm>

#include "benchmark/tables/tables.h"
#include "tests/benchmark/scored_cell.h"

using namespace raymoval;

namespace {

Cell cell(const std::string& sequence, const std::string& method, double pr, double rr, double f1) {
  return test::timed_cell(sequence, method, pr, rr, f1, 0.004);
}

/// Two points of a sweep on two sequences; on the second the second point failed.
RunResults swept_run() {
  RunResults results;
  results.name = "test";
  results.sequences = {"s1", "s2"};
  results.methods = {"x:size=1", "x:size=2", "y"};
  results.protocols = {"erasor"};
  results.sweeps = {{"x:size=1", "x", {{"size", "1"}}}, {"x:size=2", "x", {{"size", "2"}}}};
  results.cells = {
      cell("s1", "x:size=1", 90, 60, 0.72), cell("s2", "x:size=1", 80, 80, 0.8),
      cell("s1", "x:size=2", 80, 80, 0.8),  test::failed_cell("s2", "x:size=2", "did not finish"),
      cell("s1", "y", 50, 50, 0.5),         cell("s2", "y", 50, 50, 0.5)};
  results.cells[3].output_tail = "scan 6\nscan 7 ...\n";
  return results;
}

}  // namespace

TEST_CASE("A sweep has a table of its own, the curve") {
  const std::vector<TextTable> tables = make_tables(swept_run());
  REQUIRE(tables.size() == 4);
  REQUIRE(tables[0].rows.size() == 2);  // Only y is in the table of methods.
  CHECK(tables[0].rows[0].label == "y");
  const TextTable& curve = tables[2];
  CHECK(curve.title == "Sweep of x over size by protocol erasor");
  CHECK(curve.groups[0].columns == std::vector<std::string>{"PR", "RR", "F1", "ms per scan"});
  // PR alone decides nothing. The means are of the points that have a value.
  CHECK(test::rows_of(curve) ==
        std::vector<std::string>{
            "s1, size=1: 90.000, 60.000, 0.7200+, 4.0", "s1, size=2: 80.000, 80.000, 0.8000*, 4.0",
            "s2, size=1: 80.000, 80.000, 0.8000, 4.0", "s2, size=2: timeout, timeout, timeout, n/a",
            "mean over the sequences, size=1: 85.000, 70.000, 0.7600+, 4.0",
            "mean over the sequences, size=2: 80.000 (1/2), 80.000 (1/2), 0.8000 (1/2)*, 4.0"});
}

TEST_CASE("Two sweeps of one variant have a table each, and rows that say what was set") {
  RunResults results = swept_run();
  results.methods.emplace_back("x:test=true");
  results.sweeps.push_back({"x:test=true", "x", {{"test", "true"}}});
  results.cells.push_back(cell("s1", "x:test=true", 80, 80, 0.8));
  std::vector<std::string> titles, labels;
  for (const TextTable& table : make_tables(results)) {
    if (!table.title.starts_with("Sweep")) continue;
    titles.push_back(table.title);
    labels.push_back(table.rows[0].label);
  }
  CHECK(titles == std::vector<std::string>{"Sweep of x over size by protocol erasor",
                                           "Sweep of x over test by protocol erasor"});
  CHECK(labels == std::vector<std::string>{"size=1", "test=true"});
}

TEST_CASE("Cells without a result are listed with reason and last words") {
  RunResults results = swept_run();
  results.missing = {"s1 / z"};
  results.cells[3].reason = std::string(300, 'r');
  const TextTable table = make_tables(results).back();
  CHECK(table.title == "Cells without a result");
  REQUIRE(table.rows.size() == 2);
  CHECK(table.rows[0].label == "s2 / x:size=2");
  CHECK(table.rows[0].cells[0].text == "timeout");
  CHECK(table.rows[0].cells[1].text == std::string(200, 'r') + " ...");
  CHECK(table.rows[0].cells[2].text == "scan 7 ...");
  CHECK(table.rows[1].cells[0].text == "not run");
}
