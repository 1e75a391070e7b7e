// SPDX-License-Identifier: MIT
#include "benchmark/tables/comparison_files.h"

#include <catch2/catch.hpp>

using namespace raymoval;
using Catch::Matchers::Contains;

namespace {

/// A method with one rate and one count, by protocol "erasor".
ComparedCell cell(const std::string& sequence, const std::string& name, double f1) {
  ComparedScore score;
  score.protocol = "erasor";
  score.counts = {{"removed_points", static_cast<std::int64_t>(f1 * 1000)}};
  score.rates = {{"F1", f1, ""}};
  ComparedCell made;
  made.sequence = sequence;
  made.name = name;
  made.identity = {{"data fingerprint", "abc"}};
  made.method_version = "1";
  made.scores = {score};
  return made;
}

ComparisonSubject subject() {
  return {"out/new", "out/old"};
}

/// One of each: the same, better, worse, not comparable, missing in the run, only in the run.
Comparison one_of_each() {
  ResultSet run{{cell("s", "same:v", 0.5), cell("s", "better:v", 0.6), cell("s", "worse:v", 0.4),
                 cell("t", "other:v", 0.5), cell("t", "new:v", 0.5)},
                {}};
  const ResultSet reference{
      {cell("s", "same:v", 0.5), cell("s", "better:v", 0.5), cell("s", "worse:v", 0.5),
       cell("t", "other:v", 0.5), cell("t", "gone:v", 0.5)},
      {}};
  run.cells[3].identity["data fingerprint"] = "xyz";
  return compare_results(run, reference, {});
}

}  // namespace

TEST_CASE("A comparison as JUnit has a test case for each cell and protocol") {
  const std::string xml = comparison_in("junit", one_of_each(), subject());
  CHECK_THAT(xml, Contains("<testsuites name=\"raymoval compare\" tests=\"7\" failures=\"1\" "
                           "errors=\"2\" skipped=\"1\">"));
  CHECK_THAT(xml, Contains("<testsuite name=\"s\" tests=\"3\" failures=\"1\" errors=\"0\""));
  CHECK_THAT(xml, Contains("<testcase classname=\"s\" name=\"same:v, erasor\"/>"));
  CHECK_THAT(xml, Contains("<failure type=\"worse\" message=\"F1 0.5000 -&gt; 0.4000 (-0.1000)"));
  CHECK_THAT(xml, Contains("<system-out>better: F1 0.5000 -&gt; 0.6000"));
  CHECK_THAT(xml, Contains("<error type=\"not comparable\" message=\"missing in the run\"/>"));
  CHECK_THAT(xml, Contains("<error type=\"not comparable\" message=\"data fingerprint is xyz"));
  CHECK_THAT(xml, Contains("<skipped message=\"not in the reference, not compared\"/>"));
}

TEST_CASE("Names and reasons cannot break out of JUnit or Markdown") {
  ComparedCell before = cell("a<b", "x&\"y\"", 0.5), after = before;
  after.status = "failed";
  after.reason = "]]> <boom> & \x01 | pipe";
  const Comparison comparison = compare_results({{after}, {}}, {{before}, {}}, {});
  const std::string xml = comparison_in("junit", comparison, subject());
  CHECK_THAT(xml, Contains("classname=\"a&lt;b\" name=\"x&amp;&quot;y&quot;, erasor\""));
  CHECK_THAT(xml, Contains("]]&gt; &lt;boom&gt; &amp;") && !Contains("\x01"));
  CHECK_THAT(comparison_in("md", comparison, subject()), Contains("\\| pipe") && Contains("a\\<b"));
}

TEST_CASE("Problems of the whole run fail a test case of their own") {
  const ResultSet good{{cell("s", "m:v", 0.5)}, {}};
  const ResultSet off{good.cells, {"control 'noop' is off"}};
  CHECK_THAT(comparison_in("junit", compare_results(off, good, {}), subject()),
             Contains("name=\"controls\">") && Contains("control 'noop' is off"));
  // Times that are to be judged and are not there are no silent pass.
  ComparisonOptions timed;
  timed.time_band = 3.0;
  CHECK_THAT(comparison_in("junit", compare_results(good, good, timed), subject()),
             Contains("errors=\"1\"") && Contains("no times"));
}

TEST_CASE("Times beyond their band are test cases that fail") {
  ComparedCell before = cell("s", "m:v", 0.5), after = before;
  before.seconds_per_scan = 0.1;
  after.seconds_per_scan = 0.4;
  ComparisonOptions options;
  options.time_band = 3.0;
  const Comparison comparison = compare_results({{after}, {}}, {{before}, {}}, options);
  CHECK_THAT(comparison_in("junit", comparison, subject()),
             Contains("name=\"m:v, time\">") && Contains("<failure type=\"worse\" message=\"4.00"));
}

TEST_CASE("A comparison as Markdown has a row for each score that is not the same") {
  const std::string text = comparison_in("md", one_of_each(), subject());
  CHECK_THAT(text, Contains("**out/new against out/old: not comparable** (1 of 5 cells"));
  CHECK_THAT(text, Contains("| worse | s | worse:v | erasor | F1 0.5000 -> 0.4000 (-0.1000) |"));
  CHECK_THAT(text, !Contains("same:v"));
}

TEST_CASE("An unknown format suggests the nearest") {
  CHECK_THROWS_WITH(comparison_in("junut", {}, subject()), Contains("Did you mean 'junit'"));
}
