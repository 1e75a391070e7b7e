// SPDX-License-Identifier: MIT
#include "benchmark/tables/tables.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "benchmark/tables/published_columns.h"
#include "core/error.h"
#include "core/files/files.h"
#include "tests/benchmark/scored_cell.h"

using namespace raymoval;
using Catch::Matchers::Contains;
using test::rows_of, test::score_by, test::scored_cell;

namespace {

/// Methods x and y_1 on s1 and s2; nothing moves in s2 for y_1, so its RR and F1 are undefined.
RunResults two_by_two() {
  RunResults results;
  results.name = "test";
  results.sequences = {"s1", "s2"};
  results.methods = {"x", "y_1"};
  results.protocols = {"erasor"};
  results.cells = {
      scored_cell("s1", "x", 90.0, 60.0, 0.72), scored_cell("s2", "x", 70.0, 100.0, 14.0 / 17.0),
      scored_cell("s1", "y_1", 80.0, 80.0, 0.8), scored_cell("s2", "y_1", 50.0, {}, {})};
  return results;
}

TableOptions paper_layout() {
  TableOptions options;
  options.layout = TableLayout::kSequenceRows;
  return options;
}

TableOptions with_papers(const std::vector<OutsideColumn>& outside) {
  TableOptions options = paper_layout();
  options.outside = outside;
  return options;
}

}  // namespace

TEST_CASE("The paper's layout marks best and second and names both averages of F1") {
  const std::vector<TextTable> tables = make_tables(two_by_two(), paper_layout());
  REQUIRE(tables.size() == 1);
  CHECK(rows_of(tables[0]) ==
        std::vector<std::string>{
            "s1: 90.000*, 60.000+, 0.7200+, 80.000+, 80.000*, 0.8000*",
            "s2: 70.000*, 100.000, 0.8235, 50.000+, n/a, n/a",
            // x: PR (90 + 70) / 2, RR (60 + 100) / 2, F1 (0.72 + 0.823529) / 2 = 0.771765. RR and
            // F1 of y_1 are over one of two sequences, and say so.
            "mean_PR, mean_RR, mean_F1: 80.000*, 80.000*, 0.7718+, 65.000+, 80.000 (1/2)*, "
            "0.8000 (1/2)*",
            // F1 of 80 and 80 is 0.8.
            "F1_of_means: , , 0.8000*, , , 0.8000 (1/2)*"});
}

TEST_CASE("What was said and what came true stand in a table for each method that was asked") {
  RunResults results = two_by_two();
  CHECK(reliability_tables(results).empty());
  MethodReliability method{"x", 2, {}};
  method.all.bins[0] = {300, 30, 300 * 10};   // Said 0.04, and 0.1 move.
  method.all.bins[9] = {100, 80, 100 * 235};  // Said 0.94, and 0.8 move.
  results.reliability = {method};
  const std::vector<TextTable> tables = reliability_tables(results);
  REQUIRE(tables.size() == 1);
  CHECK(tables[0].title == "Confidence of x");
  CHECK(tables[0].rows[0].label == "0.0 to 0.1");
  CHECK(tables[0].rows[0].cells[0].text == "300");
  CHECK(tables[0].rows[0].cells[1].text == "0.040");
  CHECK(tables[0].rows[0].cells[2].text == "0.100");
  CHECK(tables[0].rows[5].cells[1].text == "-");
  CHECK(tables[0].rows[9].cells[2].text == "0.800");
  // (300 x 0.06 + 100 x 0.14) / 400, and (0.06 + 0.14) / 2.
  CHECK_THAT(tables[0].notes[0], Contains("over 2 sequences") && Contains("error 0.08000") &&
                                     Contains("mean gap 0.100"));
}

TEST_CASE("Markdown columns are aligned, LaTeX is escaped") {
  const RunResults results = two_by_two();
  const std::string markdown = tables_markdown(results, {make_tables(results)[0]});
  CHECK_THAT(markdown, Contains("**90.000**") && Contains("<u>80.000</u>"));
  std::size_t width = 0;
  for (std::size_t at = markdown.find("\n|"); at != std::string::npos;
       at = markdown.find("\n|", at + 1)) {
    const std::size_t length = markdown.find('\n', at + 1) - at;
    if (width == 0) width = length;
    CHECK(length == width);
  }
  const std::string latex = tables_latex(make_tables(results, paper_layout()));
  CHECK_THAT(latex, Contains("\\multicolumn{3}{c}{y\\_1}") && Contains("\\toprule") &&
                        Contains("\\textbf{90.000}") && Contains("\\underline{80.000}"));
}

TEST_CASE("The CSV has rates to 3 decimals, F1 to 4, and nothing where undefined") {
  RunResults results = two_by_two();
  results.cells[0].measured.emplace().mean_seconds = 0.25;
  results.cells[0].measured->peak_memory_mib = 12.34;
  const std::string csv = results_csv(results);
  CHECK_THAT(csv, Contains("\ns1,x,v,erasor,ok,90.000,60.000,0.7200,,,,,,,,,,0.250000,12.3,x\n"));
  CHECK_THAT(csv, Contains("\ns2,y_1,v,erasor,ok,50.000,,,,,,,,,,,,,,y_1\n"));
}

TEST_CASE("Outside columns stand beside the run where a sequence is in both") {
  RunResults results = two_by_two();
  results.sequences[0] = results.cells[0].sequence = results.cells[2].sequence = "kitti-05";
  const OutsideColumn paper{
      "paper", "erasor", {{"05", {{"PR", 88.0}, {"RR", 90.0}, {"F1", 0.89}}, "kitti-05"}}};
  const std::vector<TextTable> tables = make_tables(results, with_papers({paper}));
  REQUIRE(tables.size() == 2);
  REQUIRE(tables[0].groups.size() == 3);
  CHECK(tables[0].rows[0].cells[6].text == "88.000");
  CHECK(tables[0].rows[0].cells[8].text == "0.890");
  CHECK(tables[0].rows[1].cells[6].text == "-");
  CHECK(tables[1].title == "Published");
  // The tables of a run without the sequences of papers have no rows of papers.
  REQUIRE(make_tables(two_by_two(), with_papers({paper})).size() == 1);
  CHECK(make_tables(two_by_two(), with_papers({paper}))[0].groups.size() == 2);
}

TEST_CASE("Stage times are means per scan with the rest named") {
  RunResults results;
  results.times = {{"x", 4, 2.0, 0.4, {{"cast", 1.5}}}};
  const std::vector<TextTable> tables = make_tables(results);
  REQUIRE(tables.size() == 1);
  // 1.5 s over 4 scans is 375 ms of 500 ms.
  CHECK(rows_of(tables[0]) == std::vector<std::string>{"cast: 375.000, 75.0",
                                                       "other: 125.000, 25.0",
                                                       "total: 500.000, 100.0"});
}

TEST_CASE("Stages that are summed over threads have shares of their sum") {
  RunResults results;
  // Two threads did 3 s of casting and 1 s of clustering in 2.5 s.
  results.times = {{"x", 4, 2.5, 0.4, {{"cast", 3.0}, {"cluster", 1.0}}, 2}};
  const TextTable table = make_tables(results).at(0);
  CHECK(rows_of(table) == std::vector<std::string>{"cast: 750.000, 75.0", "cluster: 250.000, 25.0",
                                                   "sum over threads: 1000.000, 100.0",
                                                   "wall time: 625.000, -"});
  CHECK_THAT(table.notes.at(1), Contains("2 threads") && Contains("shares are of the sum"));
}

namespace {

/// Method x on s1 and s2 and y_1 on s1, by points: rates of another protocol on the same cells.
void add_points_protocol(RunResults& results) {
  results.protocols.push_back("dynamicmap");
  const auto add = [&](std::size_t cell, double sa, double da) {
    const double ha = 2.0 * sa * da / (sa + da);
    results.cells[cell].scores.push_back(
        score_by("dynamicmap", {{"SA", sa}, {"DA", da}, {"AA", 1.0}, {"HA", ha}}));
  };
  add(0, 50.0, 50.0);
  add(1, 40.0, 60.0);
  add(2, 75.0, 25.0);
}

}  // namespace

TEST_CASE("A protocol with SA and DA has a table with its columns, and can be asked for alone") {
  RunResults results = two_by_two();
  add_points_protocol(results);
  const std::vector<TextTable> tables = make_tables(results, paper_layout());
  REQUIRE(tables.size() >= 2);
  CHECK(tables[1].title == "Accuracy by protocol dynamicmap");
  REQUIRE(tables[1].groups.size() == 2);
  CHECK(tables[1].groups[0].columns == std::vector<std::string>{"SA", "DA", "AA", "HA"});
  CHECK(tables[1].rows[1].cells[3].text == "48.000");  // 2 40 60 / 100.
  CHECK(tables[1].rows[0].cells[4].mark == Mark::kBest);
  CHECK(tables[1].rows[0].cells[7].text == "37.500");
  CHECK_THAT(results_csv(results),
             Contains("\ns2,x,v,dynamicmap,ok,,,,40.000,60.000,1.000,48.000"));
  choose_protocols(results, {"dynamicmap"});
  CHECK(results.protocols == std::vector<std::string>{"dynamicmap"});
  REQUIRE(make_tables(results, paper_layout()).size() == 1);
  CHECK(make_tables(results, paper_layout())[0].title == "Accuracy by protocol dynamicmap");
  CHECK_THROWS_WITH(choose_protocols(results, {"dynamicmpa"}), Contains("'dynamicmap'"));
}

TEST_CASE("Published numbers of a protocol stand beside those of that protocol only") {
  RunResults results = two_by_two();
  add_points_protocol(results);
  results.sequences[0] = results.cells[0].sequence = results.cells[2].sequence = "kth-00";
  const OutsideColumn paper{"A", "erasor", {{"00", {{"PR", 88.0}, {"RR", 90.0}, {"F1", 0.89}}}}};
  const OutsideColumn kth{"B", "dynamicmap", {{"00", {{"SA", 96.76}, {"DA", 90.68}}, "kth-00"}}};
  std::vector<TextTable> tables = make_tables(results, with_papers({paper, kth}));
  // "kth-00" is every frame, and no segment of the first protocol's papers.
  CHECK(tables[0].groups.size() == 2);
  REQUIRE(tables[1].groups.size() == 3);
  CHECK(tables[1].groups[2].heading == "B");
  CHECK(tables[1].rows[0].cells[8].text == "96.76");
  CHECK(tables[1].rows[0].cells[10].text == "-");  // AA is not printed.
  CHECK(tables[1].rows[1].cells[8].text == "-");
  REQUIRE(tables[2].title == "Published, DynamicMap benchmark");
  CHECK(tables[2].rows.size() == 1);  // No mean.
  // The strict variant has the same rates by other rules.
  for (Cell& cell : results.cells) {
    if (cell.scores.size() > 1) cell.scores[1].protocol.name = "dynamicmap-strict";
  }
  results.protocols[1] = "dynamicmap-strict";
  tables = make_tables(results, with_papers({paper, kth}));
  CHECK(tables[1].groups.size() == 2);
  CHECK(tables.size() == 2);
}

TEST_CASE("Papers' rows stand beside the same frames of a sequence only") {
  RunResults results = two_by_two();
  results.sequences = {"05"};
  for (Cell& cell : results.cells) cell.sequence = "05";
  const auto reasons = [&](const std::string& frames, std::size_t scans,
                           const std::string& protocol = "erasor") {
    results.cells[0].data = DataRecord{"05", "semantickitti", "", frames, scans};
    results.protocols = {protocol};
    std::vector<OutsideColumn> papers = published_columns();
    const std::vector<std::string> lines = set_beside(papers, results);
    const bool any = std::ranges::any_of(papers, [](const OutsideColumn& column) {
      return column.find(&OutsideRow::beside, "05") != nullptr;
    });
    CHECK(any == lines.empty());
    return lines.empty() ? "" : lines.at(0);
  };
  CHECK(reasons("2350:2670:2", 161).empty());
  // Only the scans of the segment may be in the folder.
  CHECK(reasons("2350:2670:1", 161).empty());
  CHECK(reasons("2350:2670:1", 321, "dynamicmap").empty());
  CHECK(reasons("0:9:1", 10) ==
        "05: the papers have frames 2350:2670:2 (161 scans), and this run has 0:9:1 (10 scans)");
  CHECK_THAT(reasons("2350:2670:1", 321), Contains("has 2350:2670:1 (321 scans)"));
  CHECK_THAT(reasons("2350:2670:2", 160), Contains("(160 scans)"));
  CHECK_THAT(reasons("2350:2670:2", 161, "mos"), Contains("no paper has numbers for it by mos"));
  results.sequences[0] = "01";
  for (Cell& cell : results.cells) cell.sequence = "01";
  CHECK_THAT(reasons("150:250:1", 101, "dynamicmap"), Contains("papers used is not known"));
  results.cells[0].data.reset();
  std::vector<OutsideColumn> papers = published_columns();
  results.protocols = {"erasor"};
  CHECK_THAT(set_beside(papers, results).at(0), Contains("no cell has read its scans"));
}

TEST_CASE("Tables of the kinds that are asked for") {
  RunResults results = two_by_two();
  add_points_protocol(results);
  const auto titles = [&](const std::vector<std::string>& what) {
    std::vector<std::string> list;
    for (const TextTable& table : make_tables(results, {.what = what})) list.push_back(table.title);
    return list;
  };
  CHECK(titles({"accuracy", "losses"}).size() == 4);  // No cell has shares by class.
  CHECK(titles({"accuracy"}).size() == 4);            // Of each protocol, and their means.
  CHECK(titles({}).size() == 4);
  CHECK(latex_kinds(results) == std::vector<std::string>{"accuracy"});
  results.sweeps = {{"x", "m", {{"size", "1"}}}, {"y_1", "m", {{"size", "2"}}}};
  CHECK(latex_kinds(results) == std::vector<std::string>{"sweeps"});
}

TEST_CASE("A sort puts the best first in all that is listed by method") {
  RunResults results = two_by_two();
  results.columns = {{"x", false, 2, {}}, {"y_1", false, 2, {}}};
  results.times = {{"x", 10, 2.0, 0.0, {}}, {"y_1", 10, 1.0, 0.0, {}}};
  const auto sorted = [&](const std::string& column) {
    RunResults copy = results;
    sort_results(column, copy);
    CHECK(copy.columns.front().cell == copy.methods.front());
    CHECK(copy.times.front().cell == copy.methods.front());
    return copy;
  };
  // F1: 0.77 of x, 0.8 of y_1 on s1, where it is better too; on s2 it has none.
  const RunResults by_f1 = sorted("F1");
  CHECK(by_f1.methods == std::vector<std::string>{"y_1", "x"});
  CHECK_THAT(results_csv(by_f1),
             Contains("\ns1,y_1,v,erasor,ok,80.000,80.000,0.8000,,,,,,,,,,,,y_1\n"
                      "s1,x,") &&
                 Contains("x\ns2,x,"));
  CHECK(sorted("PR").methods == std::vector<std::string>{"x", "y_1"});
  CHECK(sorted(kTimeRate).methods == std::vector<std::string>{"y_1", "x"});
  CHECK(sorted("name").methods == std::vector<std::string>{"x", "y_1"});
  CHECK(sorted("none").methods == results.methods);
}

TEST_CASE("Tables say below them on which data a method was developed") {
  RunResults results = two_by_two();
  results.developed_on = {{"a drive", {"x", "y_1"}}, {"scenes", {"z"}}};
  CHECK(make_tables(results)[0].notes == std::vector<std::string>{"Developed on a drive: x, y_1."});
  // The program knows it of its own method, whatever its name in the suite.
  ResultsRecord record;
  for (const char* method : {"raymoval:offline", "raymoval_plus:online"}) {
    SuiteMethodRecord chosen;
    chosen.name = std::string("my ") + method;
    chosen.method = method;
    record.run.methods.push_back(std::move(chosen));
  }
  const auto known = shown_results(record).developed_on;
  REQUIRE(known.size() == 1);
  CHECK(known.begin()->second == std::vector<std::string>{"my raymoval_plus:online"});
}

TEST_CASE("Tables say below them how a method differs from its variant") {
  RunResults results = two_by_two();
  results.changed = {{"x", "size = 2 (default 1)"}};
  const std::vector<TextTable> tables = make_tables(results);
  CHECK(tables[0].notes.back() == "x: size = 2 (default 1)");
  results.methods = {"y_1"};
  CHECK(make_tables(results)[0].notes.empty());
}

TEST_CASE("Every published file that tables use is read") {
  std::size_t of_benchmark = 0, of_segmentation = 0;
  for (const OutsideColumn& column : published_columns()) {
    of_benchmark += column.protocol == "dynamicmap" ? 1 : 0;
    of_segmentation += column.protocol == "mos" ? 1 : 0;
    for (const OutsideRow& row : column.rows) {
      CHECK(column.find(&OutsideRow::sequence, row.sequence) == &row.rates);
    }
  }
  // Six of the benchmark, six that DUFOMap and BeautyMap add, one that is claimed.
  CHECK(of_benchmark == 13);
  CHECK(of_segmentation == 3);  // HMM-MOS with two sizes of voxels, and Dynablox.
}

TEST_CASE("Column tables name the worst classes and add sequences up") {
  RunResults results = two_by_two();
  results.columns = {{"x",
                      false,
                      2,
                      {{"precision", {3, 4}},
                       {"recall", {0, 0}},
                       {"rejection [range 0-10 m]", {0, 1000}},
                       {"rejection [moving-car]", {50, 100}},
                       {"rejection [moving-car, range 0-10 m]", {0, 100}},
                       {"rejection [moving-bus]", {60, 200}},
                       {"rejection [moving-person]", {0, 99}},
                       {"preservation [road]", {99, 100}}}}};
  results.cells[0].scores[0].intervals.emplace().rates = {{"PR", 89.0, 91.5}, {"F1", 0.7, 0.74}};
  const std::vector<TextTable> compact = compact_column_tables(results);
  REQUIRE(compact.size() == 1);
  const std::vector<TableCell>& cells = compact[0].rows[0].cells;
  CHECK(cells[0].text == "75.000");
  CHECK(cells[1].text == "n/a");
  // Neither a band, nor a band of a class, nor a class of 99 points.
  CHECK(cells[4].text == "moving-bus 30.000");
  CHECK(cells[5].text == "road 99.000");
  CHECK(column_tables(results)[0].groups[0].columns ==
        std::vector<std::string>{"precision", "recall"});
  const std::vector<TextTable> losses = loss_tables(results);
  REQUIRE(losses.size() == 2);
  // Neither "rejection" itself nor a class within a band is a row.
  CHECK(rows_of(losses[0]) ==
        std::vector<std::string>{"range 0-10 m: 1,000, 100.00", "moving-car: 100, 50.00",
                                 "moving-bus: 200, 70.00", "moving-person: 99, 100.00"});
  CHECK(rows_of(losses[1]) == std::vector<std::string>{"road: 100, 1.00"});
  const std::vector<TextTable> intervals = interval_tables(results);
  REQUIRE(intervals.size() == 1);
  CHECK(intervals[0].groups[0].columns == std::vector<std::string>{"PR", "F1"});
  CHECK(rows_of(intervals[0]) ==
        std::vector<std::string>{"s1, x: 89.000 to 91.500, 0.7000 to 0.7400"});
}
