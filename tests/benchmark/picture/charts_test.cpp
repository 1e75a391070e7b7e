// SPDX-License-Identifier: MIT
#include "benchmark/picture/charts/charts.h"

#include <catch2/catch.hpp>

#include <algorithm>

#include "benchmark/picture/charts/plot.h"
#include "tests/benchmark/scored_cell.h"

using namespace raymoval;
using Catch::Matchers::Contains;

namespace {

/// Whether every element is closed in its place, and texts contain no markup.
bool is_well_formed(const std::string& xml) {
  std::vector<std::string> open;
  for (std::size_t at = xml.find('<'); at != std::string::npos; at = xml.find('<', at + 1)) {
    const std::size_t end = xml.find('>', at);
    if (end == std::string::npos) return false;
    const std::string tag = xml.substr(at + 1, end - at - 1);
    if (tag.find('<') != std::string::npos) return false;
    if (std::count(tag.begin(), tag.end(), '"') % 2 != 0) return false;
    const std::string name = tag.substr(0, tag.find_first_of(" /", 1));
    if (tag.starts_with('/')) {
      if (open.empty() || "/" + open.back() != tag) return false;
      open.pop_back();
    } else if (!tag.ends_with('/')) {
      open.push_back(name);
    }
  }
  for (std::size_t at = xml.find('&'); at != std::string::npos; at = xml.find('&', at + 1)) {
    const std::string entity = xml.substr(at, xml.find(';', at) + 1 - at);
    if (entity != "&amp;" && entity != "&lt;" && entity != "&gt;" && entity != "&quot;")
      return false;
  }
  return open.empty();
}

Cell cell(const std::string& method, double PR, double RR, double F1) {
  return test::scored_cell("s", method, PR, RR, F1);
}

/// x at RR 60 and PR 90, y at 100 and 100, a control, and a cell that failed.
RunResults two_points() {
  RunResults results;
  results.sequences = {"s"};
  results.methods = {"noop", "x", "y", "broken"};
  results.protocols = {"erasor"};
  results.cells = {cell("noop", 100, 0, 0), cell("x", 90, 60, 0.72), cell("y", 100, 100, 1),
                   test::failed_cell("s", "broken", "")};
  results.cells[0].method.control = true;
  results.times = {{"x", 4, 2.0, 0.4, {{"cast", 1.5}}, 1}, {"y", 4, 0.4, 0.0, {}, 1}};
  return results;
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) {
    ++found;
  }
  return found;
}

}  // namespace

TEST_CASE("PR against RR: every point is where its rates say") {
  const std::string svg = pr_rr_chart(two_points(), "erasor").svg();
  CHECK(is_well_formed(svg));
  // RR from 60 to 100 makes an axis from 50, PR from 90 an axis from 88; the plot's corner is at
  // (56, 70) and it is 460 wide and high. So RR 60 is at 56 + 10 / 50 * 460 = 148, and PR 90 at
  // 70 + 460 - 2 / 12 * 460 = 453.33. The first series has circles.
  CHECK_THAT(svg, Contains("cx=\"148\" cy=\"453.33\" r=\"5\"><title>x on s: PR 90.000, RR 60.000, "
                           "F1 0.7200</title>"));
  // Squares of 8.8 pixels, here about the upper right corner at (516, 70).
  CHECK_THAT(svg, Contains("points=\"511.6,65.6 520.4,65.6 520.4,74.4 511.6,74.4 \""));
  CHECK(svg.find("noop") == std::string::npos);
  CHECK(count(svg, "class=\"mark\"") == 2 + 3);  // Two points; the legend has the failed one too.
}

TEST_CASE("What was said against what came true: each bin is where it says") {
  RunResults results = two_points();
  CHECK(reliability_chart(results).empty());
  MethodReliability method{"x", 1, {}};
  method.all.bins[9] = {200, 150, 200 * 225};  // Said 0.9, and 0.75 move.
  method.all.bins[5] = {99, 0, 99 * 125};      // Too few.
  results.reliability = {method};
  const std::string svg = reliability_chart(results).svg();
  CHECK(is_well_formed(svg));
  // The plot's corner is at (56, 44) and it is 300 wide and high: 56 + 270, 44 + 75.
  CHECK_THAT(svg, Contains("cx=\"326\" cy=\"119\" r=\"5\"><title>x: said 0.900, 0.750 of 200 "
                           "points move</title>"));
  CHECK(count(svg, "class=\"mark\"") == 1 + 1);  // One of them in the legend.
}

TEST_CASE("Intervals are bars over their ends, the best method first") {
  RunResults results = two_points();
  CHECK(interval_chart(results, "erasor", "s").empty());
  // x has F1 0.72 from 0.7 to 0.75, y has 1 from 0.9 to 1. The axis begins at 0.6; the plot begins
  // behind the names, at 16 + 6.8 + 10 = 32.8, and is 230 wide. y is in the first row of 26 pixels.
  results.cells[1].scores[0].intervals.emplace().rates = {{"F1", 0.7, 0.75}};
  results.cells[2].scores[0].intervals.emplace().rates = {{"F1", 0.9, 1.0}};
  const std::string svg = interval_chart(results, "erasor", "s").svg();
  CHECK(is_well_formed(svg));
  CHECK_THAT(svg, Contains("class=\"bar\" stroke=\"#D55E00\" points=\"205.3,57 262.8,57 \""));
  CHECK_THAT(svg, Contains("class=\"bar\" stroke=\"#0072B2\" points=\"90.3,83 119.05,83 \""));
  CHECK_THAT(svg, Contains("cx=\"101.8\" cy=\"83\" r=\"5\"><title>x: F1 0.7200, interval 0.7000 to "
                           "0.7500</title>"));
  CHECK(count(svg, "class=\"bar\"") == 2);
  CHECK(count(svg, "class=\"mark\"") == 6);  // F1, PR and RR.
  CHECK(interval_chart(results, "erasor", "other").empty());
}

TEST_CASE("Shares of points by range, time and class are where their parts are") {
  RunResults results = two_points();
  CHECK(parts_chart(results, "s").empty());
  results.cells[1].columns = ColumnRecord{"1",
                                          {{"rejection [range 10-20 m]", {150, 200}, ""},
                                           {"rejection [range 20-30 m]", {200, 200}, ""},
                                           {"rejection [range 30-40 m]", {0, 99}, ""},
                                           {"rejection [time 90-100 %]", {50, 100}, ""},
                                           {"rejection [moving-car]", {180, 200}, ""},
                                           {"rejection [moving-car, range 10-20 m]", {1, 200}, ""},
                                           {"preservation [road]", {0, 99}, ""}}};
  const std::string svg = parts_chart(results, "s").svg();
  CHECK(is_well_formed(svg));
  // Plots are 230 wide and 180 high with their corners at (56, 76) and (360, 76). From 75 to 100 %
  // the axis begins at 70; 10 to 20 m is at 15 of 60 m, 90 to 100 % at 95 of 100 %.
  CHECK_THAT(svg, Contains("points=\"113.5,226 151.83,76 \""));
  CHECK_THAT(svg, Contains("cx=\"113.5\" cy=\"226\" r=\"5\"><title>x, range 10-20 m: 75.00 % of "
                           "moving points removed</title>"));
  CHECK_THAT(svg, Contains("<title>x, time 90-100 %: 50.00 % of moving points removed</title>"));
  CHECK_THAT(svg, Contains(">moving-car</text>"));
  CHECK(count(svg, "class=\"mark\"") == 4 + 1);      // The legend has x alone.
  CHECK(svg.find("static") == svg.rfind("static"));  // In the description: too few points.
  CHECK(svg.find("30-40") == std::string::npos);
}

TEST_CASE("Lines of equal F1 go through the points that have it") {
  const std::string svg = pr_rr_chart(two_points(), "erasor").svg();
  // F1 0.9 where one rate is 100 and the other 90 * 100 / (200 - 90) = 81.818: at RR 81.818 the
  // line leaves the plot at the top, 56 + 31.818 / 50 * 460 = 348.73.
  CHECK_THAT(svg, Contains("class=\"iso\" points=\"348.73,70 "));
  CHECK_THAT(svg, Contains(">0.9</text>"));
}

TEST_CASE("Rates of the other protocol are played against each other in the same way") {
  RunResults results = two_points();
  for (Cell& one : results.cells) {
    if (!one.ok()) continue;
    one.scores = {test::score_by("dynamicmap", {{"SA", 99.0}, {"DA", 80.0}, {"HA", 88.5}})};
  }
  results.protocols = {"dynamicmap"};
  const std::string svg = pr_rr_chart(results, "dynamicmap").svg();
  CHECK(is_well_formed(svg));
  CHECK_THAT(svg, Contains("SA, %") && Contains("DA, %") && Contains("equal HA"));
  CHECK(pr_rr_chart(results, "erasor").empty());
}

TEST_CASE("Points of a sweep look alike and are joined") {
  RunResults results = two_points();
  results.sweeps = {{"x", "swept", {{"tau", "1"}}}, {"y", "swept", {{"tau", "2"}}}};
  const std::string svg = pr_rr_chart(results, "erasor").svg();
  CHECK_THAT(svg, Contains("class=\"joined\" stroke=\"#0072B2\" points=\"148,453.33 516,70 \""));
  CHECK(count(svg, "<circle") == 3);  // Two points and their legend.
}

TEST_CASE("Accuracy against time: logarithmic, with the line that nobody beats") {
  const std::string svg = accuracy_time_chart(two_points(), "erasor").svg();
  CHECK(is_well_formed(svg));
  // 500 and 100 ms: the axis runs from 10 to 1000 ms over 640 pixels from 64. F1 from 0.72 to 1
  // makes an axis from 0.7; x is at 64 + 640 * (2.69897 - 1) / 2 = 607.67 and 48 + 340 - 0.02 / 0.3
  // * 340 = 365.33.
  CHECK_THAT(svg, Contains("cx=\"607.67\" cy=\"365.33\""));
  // y is faster and better: no other method is on the line.
  CHECK_THAT(svg, Contains("class=\"front\" points=\"384,48 \""));
  CHECK_THAT(svg, Contains("Pareto line"));
}

TEST_CASE("Charts take any name, and the same results give the same bytes") {
  RunResults results = two_points();
  const std::string odd = "a<b & \"c\"\x01\xFF \xC3\xA9";
  results.methods[1] = results.cells[1].name = results.times[0].cell = odd;
  results.sequences[0] = "<s>";
  for (Cell& one : results.cells) one.sequence = "<s>";
  for (const std::string& svg :
       {pr_rr_chart(results, "erasor").svg(), accuracy_time_chart(results, "erasor").svg()}) {
    CHECK(is_well_formed(svg));
    CHECK_THAT(svg, Contains("a&lt;b &amp; &quot;c&quot; \xEF\xBF\xBD \xC3\xA9"));
  }
  CHECK(pr_rr_chart(results, "erasor").svg() == pr_rr_chart(results, "erasor").svg());
}

TEST_CASE("A chart for a page leaves its style to the page") {
  const std::string page = pr_rr_chart(two_points(), "erasor").svg("");
  CHECK(page.find("<style>") == std::string::npos);
  CHECK_THAT(pr_rr_chart(two_points(), "erasor").svg(),
             Contains("<style>") && Contains("prefers-color-scheme:dark"));
  CHECK_THAT(chart_style(), Contains("--chart-ink"));
}

TEST_CASE("No colour comes twice in a chart") {
  for (const std::size_t count : {1U, 6U, 7U, 13U, 40U}) {
    std::vector<std::string> colours;
    for (std::size_t i = 0; i < count; ++i) {
      colours.push_back(colour_text(series_style(i, count).colour));
    }
    CHECK(colours.front() == colour_text(kSeriesColours.front()));
    std::sort(colours.begin(), colours.end());
    CHECK(std::adjacent_find(colours.begin(), colours.end()) == colours.end());
    CHECK(std::find(colours.begin(), colours.end(), "#FFFFFF") == colours.end());
  }
}

TEST_CASE("Points of a sweep carry what they were set to, apart from each other") {
  RunResults results = two_points();
  results.sweeps = {{"x", "m", {{"tau", "0.1"}}}, {"y", "m", {{"tau", "0.35"}}}};
  const std::string svg = pr_rr_chart(results, "erasor").svg();
  CHECK_THAT(svg, Contains(">0.1</text>") && Contains(">0.35</text>"));
  CHECK_THAT(svg, Contains("m over tau"));
  CHECK_THAT(accuracy_time_chart(results, "erasor").svg(), Contains(">0.35</text>"));
  // Where both points are one, they share a text.
  results.cells[2].scores = results.cells[1].scores;
  CHECK_THAT(pr_rr_chart(results, "erasor").svg(), Contains(">0.1, 0.35</text>"));
}

TEST_CASE("One panel is large and has the methods' names, several have not") {
  RunResults results = two_points();
  CHECK(count(pr_rr_chart(results, "erasor").svg(), "class=\"small\"") == 2);
  results.sequences.push_back("t");
  CHECK(count(pr_rr_chart(results, "erasor").svg(), "class=\"small\"") == 0);
}

TEST_CASE("Rates over a parameter: each point is where its value and its rate say") {
  RunResults results = two_points();
  CHECK(sweep_chart(results, "erasor").empty());
  // In the order of the values, for any order of the cells.
  results.sweeps = {{"x", "m", {{"delay", "2"}}}, {"y", "m", {{"delay", "0.5"}}}};
  const std::string svg = sweep_chart(results, "erasor").svg();
  CHECK(is_well_formed(svg));
  CHECK_THAT(svg, Contains(">m over delay</text>") && Contains(">delay</text>"));
  // From 0.5 to 2 the axis has steps of 0.5. Its plots are 230 wide and high with their corners at
  // (56, 92), (360, 92) and (664, 92). PR has an axis from 88 to 100, RR from 50, F1 from 0.7.
  CHECK_THAT(svg, Contains("points=\"56,92 286,283.67 \""));
  CHECK_THAT(svg, Contains("points=\"360,92 590,276 \""));
  CHECK_THAT(svg, Contains("points=\"664,92 894,306.67 \""));
  CHECK_THAT(svg, Contains("<title>s at delay 2: F1 0.7200</title>"));
  CHECK(count(svg, "mean") == 1);  // In the description.
}

TEST_CASE("Rates over a parameter: several sequences have a mean where all have a value") {
  RunResults results = two_points();
  results.sweeps = {{"x", "m", {{"delay", "2"}}}, {"y", "m", {{"delay", "0.5"}}}};
  results.sequences.emplace_back("t");
  results.cells.push_back(cell("y", 98, 90, 0.94));
  results.cells.back().sequence = "t";
  const std::string svg = sweep_chart(results, "erasor").svg();
  CHECK(is_well_formed(svg));
  CHECK_THAT(svg, Contains("<title>mean at delay 0.5: F1 0.9700</title>") &&
                      Contains("<title>t at delay 0.5: F1 0.9400</title>"));
  CHECK(svg.find("mean at delay 2") == std::string::npos);
  CHECK(count(svg, "class=\"joined\"") == 3);  // Of s, a plot for each rate.
}

TEST_CASE("What is no number, or stays the same, is no curve") {
  RunResults results = two_points();
  const auto is_empty = [&](const std::string& first, const std::string& second) {
    results.sweeps = {{"x", "m", {{"p", first}}}, {"y", "m", {{"p", second}}}};
    return sweep_chart(results, "erasor").empty();
  };
  CHECK(is_empty("true", "false"));
  CHECK(is_empty("1", "1"));
  CHECK_FALSE(is_empty("-1", "1"));
  results.sweeps = {{"x", "m", {{"p", "1"}, {"q", "1"}}}, {"y", "m", {{"p", "2"}, {"q", "1"}}}};
  CHECK(sweep_chart(results, "erasor").empty());
}

TEST_CASE("Two sweeps of one variant are two series") {
  RunResults results = two_points();
  results.sweeps = {{"x", "m", {{"tau", "1"}}}, {"y", "m", {{"test", "true"}}}};
  const std::vector<ChartSeries> series = chart_series(results);
  REQUIRE(series.size() == 3);  // And the broken one.
  CHECK(series[0].name == "m over tau");
  CHECK(series[1].name == "m over test");
}

TEST_CASE("Axes begin and end at round numbers") {
  RateSpec rate{.name = "PR"};
  const Axis percent = axis_to_best(rate, 97.2);
  CHECK(percent.low == Approx(97.0));  // A point at 97.2 is above the axis.
  CHECK(axis_to_best(rate, 0.0).low == 0.0);
  CHECK(axis_to_best(rate, 100.0).low < 100.0);  // All at the upper end: still an axis.
  CHECK(axis_to_best(rate, 0.0).marks() == std::vector<double>{0, 20, 40, 60, 80, 100});
  // Where lower is better the axis runs from a round number above the worst value to 0.
  rate.unit = RateUnit::kFraction;
  rate.higher_is_better = false;
  const Axis mistakes = axis_to_best(rate, 0.083);
  CHECK(mistakes.high == Approx(0.1));
  CHECK(mistakes.at(0.0, 200.0) == 200.0);
  CHECK(mistakes.at(0.1, 200.0) == Approx(0.0).margin(1e-9));
  CHECK(axis_to_best(rate, 0.0).high > 0.0);
  CHECK(axis_to_best(rate, 1.0).high == 1.0);
}
