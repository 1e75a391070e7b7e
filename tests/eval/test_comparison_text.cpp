// SPDX-License-Identifier: MIT
// What a comparison says, word by word.
#include <catch2/catch.hpp>

#include "core/error.h"
#include "eval/comparison/compare.h"

using namespace raymoval;
using Catch::Matchers::Contains;

namespace {

/// A cell with one rate and one count.
ComparedCell cell_of(const std::string& name, std::optional<double> pr, std::int64_t kept) {
  ComparedScore score;
  score.protocol = "erasor";
  score.identity = {{"protocol version", "1"}};
  score.counts = {{"preserved_static", kept}};
  score.rates = {{"PR", pr, ""}};
  ComparedCell cell;
  cell.sequence = "s";
  cell.name = name;
  cell.identity = {{"data fingerprint", "abc"}};
  cell.method_version = "1";
  cell.scores = {score};
  return cell;
}

Comparison compared_one(const ComparedCell& run, const ComparedCell& reference,
                        const ComparisonOptions& options = {}) {
  return compare_results({{run}, {}}, {{reference}, {}}, options);
}

}  // namespace

TEST_CASE("A comparison is told by verdict, cell by cell, with a summary") {
  ResultSet run, reference;
  reference.cells = {cell_of("a", 99.0, 990), cell_of("b", 99.0, 990), cell_of("c", 99.0, 990),
                     cell_of("d", 99.0, 990)};
  run.cells = {cell_of("a", 98.9, 989), cell_of("b", 99.0, 990), cell_of("c", 99.5, 995),
               cell_of("e", 99.0, 990)};
  run.cells[1].seconds_per_scan = 0.05;
  reference.cells[1].seconds_per_scan = 0.1;
  const Comparison result = compare_results(run, reference, {});
  CHECK(comparison_text(result) ==
        "Not comparable:\n"
        "  s / d: missing in the run\n"
        "Worse:\n"
        "  s / a, erasor: PR 99.0000 -> 98.9000 (-0.1000), preserved_static 990 -> 989 (-1)\n"
        "Better:\n"
        "  s / c, erasor: PR 99.0000 -> 99.5000 (+0.5000), preserved_static 990 -> 995 (+5)\n"
        "Moved or new:\n"
        "  s / e: not in the reference, not compared\n"
        "Time:\n"
        "  s / b: 0.50 times the reference (50.0 ms per scan, was 100.0)\n"
        "1 of 4 cells are the same as in the reference: not comparable.\n");
  REQUIRE(result.scores.size() == 5);
  const std::vector<Change> changes = {Change::kWorse, Change::kSame, Change::kBetter,
                                       Change::kIncomparable, Change::kMoved};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    CHECK(result.scores[i].change == changes[i]);
    CHECK(result.scores[i].protocol == "erasor");
  }
  REQUIRE(result.scores[0].counts.size() == 1);
  CHECK(result.scores[0].counts[0].before == 990);
  CHECK(result.scores[0].counts[0].after == 989);
  CHECK(result.scores[3].reasons == std::vector<std::string>{"missing in the run"});
  REQUIRE(result.time_changes.size() == 1);
  CHECK(result.time_changes[0].ratio() == 0.5);
  CHECK(result.time_changes[0].change == Change::kSame);
  CHECK(result.lines.size() == 4);
}

TEST_CASE("Sentences are put together if all but the sequence or the method is the same") {
  const auto told = [](const std::vector<ComparisonLine>& lines) {
    Comparison comparison;
    comparison.lines = lines;
    const std::string text = comparison_text(comparison);
    return text.substr(0, text.find("0 of 0 cells"));
  };
  const auto line = [](const char* sequence, const char* name, const char* protocol,
                       const char* text) {
    return ComparisonLine{Change::kWorse, sequence, name, protocol, text};
  };
  CHECK(told({line("s", "a", "erasor", "x"), line("t", "a", "erasor", "x")}) ==
        "Worse:\n  s, t / a, erasor: x\n");
  CHECK(told({line("s", "a", "erasor", "x"), line("t", "a", "erasor", "y"),
              line("u", "a", "dynamicmap", "x"), line("v", "b", "erasor", "x")}) ==
        "Worse:\n  s / a, erasor: x\n  t / a, erasor: y\n  u / a, dynamicmap: x\n"
        "  v / b, erasor: x\n");
  // A repeated sentence is reported once.
  CHECK(told({line("s", "a", "erasor", "x"), line("s", "a", "erasor", "x")}) ==
        "Worse:\n  s / a, erasor: x\n");
}

TEST_CASE("A fall beyond its tolerance is told with what was allowed") {
  const ComparedCell reference = cell_of("a", 99.0, 990), run = cell_of("a", 98.5, 985);
  CHECK_THAT(compared_one(run, reference, {{{"PR", 0.25}}, {}}).worse.at(0),
             Contains("PR 99.0000 -> 98.5000 (-0.5000, at most -0.25 is allowed)"));
  CHECK_THAT(compared_one(run, reference, {{{"PR", 0.0}}, {}}).worse.at(0),
             Contains("PR 99.0000 -> 98.5000 (-0.5000), "));
  CHECK_THAT(compared_one(run, reference, {{{"PR", 0.5}}, {}}).moved.at(0),
             Contains("PR 99.0000 -> 98.5000 (-0.5000), "));
}

TEST_CASE("A score that only the run has is told") {
  ComparedCell run = cell_of("a", 99.0, 990);
  run.scores.push_back(run.scores[0]);
  run.scores[1].protocol = "other";
  const Comparison result = compared_one(run, cell_of("a", 99.0, 990));
  CHECK(result.verdict() == ExitCode::kDone);
  CHECK(result.moved ==
        std::vector<std::string>{"s / a, other: not in the reference, not compared"});
  CHECK(result.same_cells == 1);
}

TEST_CASE("A control's time is not judged") {
  ComparedCell run = cell_of("noop", 99.0, 990), reference = run;
  run.control = reference.control = true;
  run.seconds_per_scan = 1.0;
  reference.seconds_per_scan = 0.1;
  const Comparison result = compared_one(run, reference, {{}, 2.0});
  CHECK(result.verdict() == ExitCode::kDone);
  CHECK(result.times.empty());
}

TEST_CASE("A change of status is told for each score that one side has") {
  const ComparedCell ok = cell_of("a", 99.0, 990);
  ComparedCell failed = ok;
  failed.status = "timeout";
  failed.scores.clear();
  const Comparison worse = compared_one(failed, ok), better = compared_one(ok, failed);
  CHECK(worse.worse == std::vector<std::string>{"s / a: ok -> timeout"});
  CHECK(better.better == std::vector<std::string>{"s / a: timeout -> ok"});
  for (const Comparison& result : {worse, better}) {
    REQUIRE(result.scores.size() == 1);
    CHECK(result.scores[0].protocol == "erasor");
  }
  failed.reason = "too slow";
  const Comparison both = compared_one(failed, failed);
  CHECK(both.moved == std::vector<std::string>{"s / a: failed in both (too slow)"});
  REQUIRE(both.scores.size() == 1);
  CHECK(both.scores[0].protocol.empty());
  CHECK(both.scores[0].change == Change::kMoved);
  // What cannot be read has no fingerprint: neither side is of other data for that.
  failed.identity.clear();
  CHECK(compared_one(ok, failed).verdict() == ExitCode::kDone);
  CHECK(compared_one(failed, ok).verdict() == ExitCode::kWorse);
}

TEST_CASE("Across parameters counts that move alone are told as that") {
  ComparedCell run = cell_of("a", 99.0, 989);
  run.identity["parameter x"] = "1";
  ComparisonOptions options;
  options.across_parameters = true;
  const Comparison result = compared_one(run, cell_of("a", 99.0, 990), options);
  CHECK(result.verdict() == ExitCode::kDone);
  CHECK(result.moved.back() == "s / a, erasor: counts moved, and no rate with them");
}
