// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include <algorithm>

#include "benchmark/result/checks/flat_sweeps.h"
#include "benchmark/suite/suite.h"
#include "benchmark/tables/tables.h"
#include "core/error.h"
#include "core/files/files.h"
#include "methods/controls/controls.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;
using Catch::Matchers::Contains;

namespace {

/// "toy" with the parameters size (1, from 0 to 10) and gap (2), which acts on sizes above 1.
const MethodRegistry& sweep_toys() {
  static const MethodRegistry registry = [] {
    MethodRegistry methods;
    MethodEntry toy = noop_entry();
    toy.name = "toy";
    toy.parameters = {{"size", 1.0, {.minimum = 0.0, .maximum = 10.0}, {}},
                      {"gap", 2.0, {.acts_when = "size > 1"}, {}}};
    toy.variants = {{"a", "", false, {}}};
    methods.add(toy);
    return methods;
  }();
  return registry;
}

Suite suite_of(const std::string& methods, const std::string& path = "street",
               const std::string& data = "") {
  const test::TemporaryFolder folder;
  write_atomically(folder.path() / "suite.json",
                   R"({"sequences": [")" + path + R"("], "methods": [)" + methods + "]}");
  return read_suite(folder.path() / "suite.json", sweep_toys(), data);
}

ResultRow row(const std::string& sequence, const std::string& cell, double pr, double rr,
              double f1) {
  ResultRow result;
  result.sequence = sequence;
  result.cell = cell;
  result.protocol = "erasor";
  result.status = "ok";
  result.rates = {{"PR", pr}, {"RR", rr}, {"F1", f1}};
  result.seconds_per_scan = 0.004;
  return result;
}

/// Two points of a sweep on two sequences; on the second the second point failed.
RunResults swept_run() {
  RunResults results;
  results.name = "test";
  results.sequences = {"s1", "s2"};
  results.cells = {"x:size=1", "x:size=2", "y"};
  results.protocols = {"erasor"};
  results.sweeps = {{"x:size=1", "x", {{"size", "1"}}}, {"x:size=2", "x", {{"size", "2"}}}};
  results.rows = {row("s1", "x:size=1", 90, 60, 0.72), row("s2", "x:size=1", 80, 80, 0.8),
                  row("s1", "x:size=2", 80, 80, 0.8),  row("s2", "x:size=2", 0, 0, 0),
                  row("s1", "y", 50, 50, 0.5),         row("s2", "y", 50, 50, 0.5)};
  results.rows[3].status = "timeout";
  results.rows[3].rates.clear();
  results.rows[3].seconds_per_scan.reset();
  results.failures = {{"s2", "x:size=2", "timeout", "did not finish", "scan 7 ..."}};
  return results;
}

}  // namespace

TEST_CASE("A sweep is a cell for each value") {
  const Suite suite = suite_of(R"({"method": "toy", "set": {"size": {"sweep": [1, 2.5]}}}, "toy")");
  REQUIRE(suite.methods.size() == 3);
  CHECK(suite.methods[0].name == "toy:a:size=1");
  CHECK(suite.methods[1].name == "toy:a:size=2.5");
  CHECK(suite.methods[1].sweep_of == "toy:a");
  CHECK(suite.methods[1].sweep == Configuration{{"size", 2.5}});
  CHECK(suite.methods[1].method.configuration == Configuration{{"size", 2.5}, {"gap", 2.0}});
  CHECK(suite.methods[2].name == "toy:a");
  CHECK(suite.methods[2].sweep.empty());
}

TEST_CASE("Two sweeps are combined, and plain values hold for all points") {
  const Suite suite = suite_of(
      R"({"method": "toy", "as": "t", "set": {"gap": {"sweep": [3, 4]}, "size": {"sweep": [1, 2]}}},
         {"method": "toy", "as": "u", "set": {"gap": 7, "size": {"sweep": [1]}}})");
  std::vector<std::string> names;
  for (const MethodRequest& request : suite.methods) names.push_back(request.name);
  CHECK(names == std::vector<std::string>{"t:gap=3,size=1", "t:gap=3,size=2", "t:gap=4,size=1",
                                          "t:gap=4,size=2", "u:size=1"});
  CHECK(suite.methods[4].method.configuration == Configuration{{"size", 1.0}, {"gap", 7.0}});
}

TEST_CASE("Slips in a sweep are named") {
  const auto sweep = [](const std::string& value) {
    return suite_of(R"({"method": "toy", "set": {"size": )" + value + "}}");
  };
  CHECK_THROWS_WITH(sweep(R"({"sweeps": [1]})"),
                    Contains("methods[0].set.size") && Contains("Did you mean 'sweep'"));
  CHECK_THROWS_WITH(sweep(R"({"sweep": []})"), Contains("a list of values"));
  CHECK_THROWS_WITH(sweep(R"({"sweep": 3})"), Contains("a list of values"));
  CHECK_THROWS_WITH(sweep(R"({"sweep": [1, 11]})"), Contains("out of range"));
  CHECK_THROWS_WITH(sweep(R"({"sweep": [1, 1.0]})"), Contains("two methods"));
  CHECK_THROWS_WITH(suite_of(R"({"method": "toy", "set": {"sise": {"sweep": [1]}}})"),
                    Contains("'size'"));
  std::string many = "0";
  for (int i = 1; i <= 1000; ++i) many += "," + std::to_string(i / 1000.0);
  CHECK_THROWS_WITH(sweep(R"({"sweep": [)" + many + "]}"), Contains("more than 1000"));
  Suite suite = sweep(R"({"sweep": [1, 2]})");
  CHECK_THROWS_WITH(apply_settings(suite, {{"toy", "size", "3"}}), Contains("sweeps"));
  CHECK_NOTHROW(apply_settings(suite, {{"toy", "gap", "3"}}));
}

TEST_CASE("{data} stands for the data's root") {
  CHECK(suite_of(R"("toy")", "{data}:kitti-05", "/kitti").sequences[0].path == "/kitti:kitti-05");
  CHECK(suite_of(R"("toy")", "{data}/av2", "/kth").sequences[0].path == "/kth/av2");
  CHECK_THROWS_WITH(suite_of(R"("toy")", "{data}:05"), Contains("--data ROOT"));
  CHECK_THROWS_WITH(suite_of(R"("toy")", "street", "/kitti"), Contains("--data is given"));
}

TEST_CASE("A sweep has a table of its own, the curve") {
  const std::vector<TextTable> tables = make_tables(swept_run());
  REQUIRE(tables.size() == 4);
  REQUIRE(tables[0].rows.size() == 2);  // Only y stands in the table of methods.
  CHECK(tables[0].rows[0].label == "y");
  const TextTable& curve = tables[2];
  CHECK(curve.title == "Sweep of x over size by protocol erasor");
  CHECK(curve.groups[0].columns == std::vector<std::string>{"PR", "RR", "F1", "ms per scan"});
  REQUIRE(curve.rows.size() == 6);  // Two points on s1, on s2, and their means.
  CHECK(curve.rows[0].label == "size=1");
  CHECK(curve.rows[0].block == "s1");
  CHECK(curve.rows[4].cells[0].text == "85.000");  // (90 + 80) / 2
  CHECK(curve.rows[4].cells[2].text == "0.7600");  // (0.72 + 0.8) / 2
  CHECK(curve.rows[3].cells[1].text == "timeout");
  CHECK(curve.rows[5].cells[2].text == "0.8000 (1/2)");
  CHECK(curve.rows[5].cells[2].mark == Mark::kBest);
  CHECK(curve.rows[1].cells[2].mark == Mark::kBest);  // 0.8 beats 0.72 on s1.
  CHECK(curve.rows[0].cells[0].mark == Mark::kNone);  // PR alone decides nothing.
  CHECK(curve.rows[4].cells[3].text == "4.0");
}

TEST_CASE("Two sweeps of one variant have a table each, and rows that say what was set") {
  RunResults results = swept_run();
  results.cells.push_back("x:test=true");
  results.sweeps.push_back({"x:test=true", "x", {{"test", "true"}}});
  results.rows.push_back(row("s1", "x:test=true", 80, 80, 0.8));
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
  results.failures[0].reason = std::string(300, 'r');
  const TextTable table = make_tables(results).back();
  CHECK(table.title == "Cells without a result");
  REQUIRE(table.rows.size() == 2);
  CHECK(table.rows[0].label == "s2 / x:size=2");
  CHECK(table.rows[0].cells[0].text == "timeout");
  CHECK(table.rows[0].cells[1].text == std::string(200, 'r') + " ...");
  CHECK(table.rows[0].cells[2].text == "scan 7 ...");
  CHECK(table.rows[1].cells[0].text == "not run");
}

TEST_CASE("Settings without effect are named, swept ones if they have none at any point") {
  const std::string line = "toy:a.gap has no effect here: it acts when size > 1.";
  CHECK(settings_without_effect(suite_of(R"("toy")")).empty());
  CHECK(settings_without_effect(suite_of(R"({"method": "toy", "set": {"gap": 3}})")) ==
        std::vector<std::string>{line});
  CHECK(settings_without_effect(suite_of(R"({"method": "toy", "set": {"gap": 3, "size": 2}})"))
            .empty());
  CHECK(settings_without_effect(
            suite_of(R"({"method": "toy", "set": {"gap": {"sweep": [3, 4]}}})")) ==
        std::vector<std::string>{line});
  // At size 2 it acts.
  CHECK(settings_without_effect(suite_of(R"({"method": "toy", "set": {"gap": {"sweep": [3, 4]},
                                                  "size": {"sweep": [1, 2]}}})"))
            .empty());
  Suite suite = suite_of(R"("toy", {"method": "toy", "as": "large", "set": {"size": 2}})");
  apply_settings(suite, {{"toy", "gap", "3"}});
  CHECK(settings_without_effect(suite) == std::vector<std::string>{line});
}

TEST_CASE("A sweep that made no difference is pointed out") {
  RunResults results = swept_run();
  CHECK(flat_sweeps(results).empty());  // Without digests nothing is known.
  results.rows[0].mask_digest = results.rows[2].mask_digest = "same";
  results.rows[1].mask_digest = "other";  // Of s2, where there is nothing to compare with.
  const std::string line =
      "size made no difference: with each of its 2 values exactly the same points were removed.";
  CHECK(flat_sweeps(results) == std::vector<std::string>{"sweep of x over size: " + line});
  const std::vector<TextTable> tables = make_tables(results);
  const auto sweep = std::find_if(tables.begin(), tables.end(), [](const TextTable& table) {
    return table.title.starts_with("Sweep of x over size");
  });
  REQUIRE(sweep != tables.end());
  CHECK(sweep->notes.back() == line);
  results.rows[2].mask_digest = "different";
  CHECK(flat_sweeps(results).empty());
}

TEST_CASE("Of a sweep over two parameters the one that made no difference is named") {
  // a changes what is removed, b does not; on s2 neither does.
  RunResults results;
  results.sequences = {"s1", "s2"};
  for (const char* a : {"1", "2"}) {
    for (const char* b : {"3", "4", "5"}) {
      const std::string cell = std::string("x:a=") + a + ",b=" + b;
      results.sweeps.push_back({cell, "x", {{"a", a}, {"b", b}}});
      for (const char* sequence : {"s1", "s2"}) {
        results.rows.push_back(row(sequence, cell, 90, 60, 0.72));
        results.rows.back().mask_digest = sequence == std::string("s1") ? a : "always";
      }
    }
  }
  CHECK(flat_sweeps(results, "x over a, b") ==
        std::vector<std::string>{
            "a made no difference on s2: with each of its 2 values exactly the same points were "
            "removed.",
            "b made no difference: with each of its 3 values exactly the same points were "
            "removed."});
}
