// SPDX-License-Identifier: MIT
#include <algorithm>
#include <catch2/catch.hpp>

#include "eval/comparison/compare.h"

using namespace raymoval;
using Catch::Matchers::Contains;

namespace {

double f1_of(double pr, double rr) {
  return pr + rr > 0.0 ? 2.0 * pr * rr / (pr + rr) / 100.0 : 0.0;
}

/// 1,000 static and 200 dynamic voxels: PR = kept / 10, RR = 100 - left / 2, both in percent.
ComparedCell cell_with(std::int64_t kept, std::int64_t left, const std::string& name = "m:v") {
  const double pr = static_cast<double>(kept) / 10.0;
  const double rr = 100.0 - static_cast<double>(left) / 2.0;
  ComparedScore score;
  score.protocol = "erasor";
  score.identity = {{"protocol version", "1"}, {"option voxel_size", "0.2"}};
  score.counts = {{"static_voxels", 1000},
                  {"dynamic_voxels", 200},
                  {"preserved_static", kept},
                  {"remaining_dynamic", left},
                  {"removed_points", 5000}};
  score.rates = {{"PR", pr, ""}, {"RR", rr, ""}, {"F1", f1_of(pr, rr), ""}};
  ComparedCell cell;
  cell.sequence = "s";
  cell.name = name;
  cell.identity = {{"data fingerprint", "abc"}, {"parameter tau0", "0.3"}};
  cell.method_version = "1";
  cell.scores = {score};
  cell.seconds_per_scan = 0.1;
  return cell;
}

ComparedCell failed_cell() {
  ComparedCell cell = cell_with(0, 0);
  cell.status = "failed";
  cell.reason = "no idea";
  cell.scores.clear();
  cell.seconds_per_scan.reset();
  return cell;
}

Comparison compared(const ComparedCell& run, const ComparedCell& reference,
                    const ComparisonOptions& options = {}) {
  return compare_results({{run}, {}}, {{reference}, {}}, options);
}

const ComparedCell kReference = cell_with(990, 20);

}  // namespace

TEST_CASE("Equal cells are the same") {
  const Comparison result = compared(kReference, kReference);
  CHECK(result.verdict() == ExitCode::kDone);
  CHECK(result.same_cells == 1);
  CHECK(result.cells == 1);
  CHECK((result.worse.empty() && result.better.empty() && result.moved.empty()));
  CHECK_THAT(comparison_text(result), Contains("1 of 1 cells") && Contains("no regression"));
}

TEST_CASE("A method that keeps one static voxel less is worse") {
  // 989 of 1,000 kept: PR 98.9 instead of 99.0.
  const Comparison result = compared(cell_with(989, 20), kReference);
  CHECK(result.verdict() == ExitCode::kWorse);
  REQUIRE(result.worse.size() == 1);
  CHECK_THAT(result.worse[0], Contains("s / m:v, erasor") &&
                                  Contains("PR 99.0000 -> 98.9000 (-0.1000)") &&
                                  Contains("preserved_static 990 -> 989 (-1)"));
  CHECK(result.same_cells == 0);
}

TEST_CASE("Better is told and no error, and better in one rate and worse in another is worse") {
  const Comparison better = compared(cell_with(990, 10), kReference);
  CHECK(better.verdict() == ExitCode::kDone);
  REQUIRE(better.better.size() == 1);
  CHECK_THAT(better.better[0], Contains("RR 90.0000 -> 95.0000 (+5.0000)"));
  // F1 rises (RR +5, PR -0.1), yet a static voxel is lost.
  CHECK(compared(cell_with(989, 10), kReference).verdict() == ExitCode::kWorse);
}

TEST_CASE("A count that moves no rate is worse, for nothing says that it is better") {
  ComparedCell run = kReference;
  run.scores[0].counts[4].second = 4999;
  const Comparison result = compared(run, kReference);
  CHECK(result.verdict() == ExitCode::kWorse);
  CHECK_THAT(result.worse.at(0), Contains("removed_points 5000 -> 4999"));
}

TEST_CASE("Counts of the truth must not move, however good the rates") {
  ComparedCell run = cell_with(990, 10);
  run.scores[0].counts[0].second = 991;
  CHECK(compared(run, kReference).verdict() == ExitCode::kWorse);
  CHECK(compared(run, kReference, {{{"F1", 1.0}}, {}}).verdict() == ExitCode::kWorse);
}

TEST_CASE("A count that is missing or new is worse") {
  ComparedCell less = kReference;
  less.scores[0].counts.pop_back();
  CHECK_THAT(compared(less, kReference).worse.at(0), Contains("removed_points is missing"));
  CHECK_THAT(compared(kReference, less).worse.at(0), Contains("removed_points is new"));
}

TEST_CASE("A tolerance judges its rate only, and up to its end") {
  // PR 99.0 -> 98.9 with RR 90: F1 = 2 PR RR / (PR + RR) falls from 0.942857 to 0.942403.
  const ComparedCell run = cell_with(989, 20);
  CHECK(compared(run, kReference, {{{"F1", 0.0004}}, {}}).verdict() == ExitCode::kWorse);
  const Comparison within = compared(run, kReference, {{{"F1", 0.0005}}, {}});
  CHECK(within.verdict() == ExitCode::kDone);
  CHECK_THAT(within.moved.at(0), Contains("F1"));
  CHECK(compared(run, kReference, {{{"PR", 0.1}}, {}}).verdict() == ExitCode::kDone);
  CHECK(compared(run, kReference, {{{"PR", 0.099}}, {}}).verdict() == ExitCode::kWorse);
  CHECK(compared(run, kReference, {{{"RR", 0.0}}, {}}).verdict() == ExitCode::kDone);
  CHECK(compared(run, kReference, {{{"PR", 0.099}, {"F1", 1.0}}, {}}).verdict() ==
        ExitCode::kWorse);
  CHECK_THROWS_WITH(compared(run, kReference, {{{"F9", 1.0}}, {}}),
                    Contains("--tolerance F9: the reference has no such metric"));
}

TEST_CASE("A rate that is no longer defined is worse") {
  ComparedCell run = kReference;
  run.scores[0].rates[1].value.reset();
  CHECK_THAT(compared(run, kReference).worse.at(0), Contains("RR 90.0000 -> undefined"));
  CHECK(compared(run, kReference, {{{"RR", 100.0}}, {}}).verdict() == ExitCode::kWorse);
}

TEST_CASE("Other data, parameters or protocols are not comparable, and it is said which") {
  const auto reason = [](const ComparedCell& run) {
    const Comparison result = compared(run, kReference);
    CHECK(result.verdict() == ExitCode::kCannotDo);
    return result.incomparable.at(0);
  };
  ComparedCell run = kReference;
  run.identity["data fingerprint"] = "xyz";
  CHECK_THAT(reason(run), Contains("data fingerprint is xyz, the reference has abc"));
  run = kReference;
  run.identity["parameter tau0"] = "0.4";
  CHECK_THAT(reason(run), Contains("s / m:v: parameter tau0 is 0.4, the reference has 0.3"));
  run.identity.erase("parameter tau0");
  CHECK_THAT(reason(run), Contains("parameter tau0 is missing"));
  run = kReference;
  run.identity["parameter new"] = "1";
  CHECK_THAT(reason(run), Contains("parameter new is 1, the reference has none"));
  run = kReference;
  run.scores[0].identity["protocol version"] = "2";
  CHECK_THAT(reason(run), Contains("erasor: protocol version is 2, the reference has 1"));
  run = kReference;
  run.scores[0].identity["option voxel_size"] = "0.1";
  CHECK_THAT(reason(run), Contains("option voxel_size"));
  run.scores[0].identity.erase("option voxel_size");
  CHECK_THAT(reason(run), Contains("erasor: option voxel_size is missing, the reference has 0.2"));
  run = kReference;
  run.scores[0].identity["option new"] = "1";
  CHECK_THAT(reason(run), Contains("erasor: option new is 1, the reference has none"));
  run = kReference;
  run.scores.clear();
  CHECK_THAT(reason(run), Contains("erasor: not scored in the run"));
}

TEST_CASE("A cell that is missing is not comparable, one that is new is only told") {
  const ComparedCell other = cell_with(500, 100, "other:v");
  const ResultSet one{{kReference}, {}}, two{{kReference, other}, {}}, none;
  const Comparison missing = compare_results(one, two, {});
  CHECK(missing.verdict() == ExitCode::kCannotDo);
  CHECK(missing.incomparable.at(0) == "s / other:v: missing in the run");
  const Comparison fresh = compare_results(two, one, {});
  CHECK(fresh.verdict() == ExitCode::kDone);
  CHECK_THAT(fresh.moved.at(0), Contains("s / other:v"));
  CHECK(compare_results(one, none, {}).verdict() == ExitCode::kCannotDo);
}

TEST_CASE(
    "A cell with a changed parameter is compared with that of its variant if it has no other") {
  const ComparedCell changed = cell_with(980, 20, "m:v*");
  CHECK(compared(changed, kReference).verdict() == ExitCode::kWorse);
  CHECK(compared(kReference, changed).verdict() == ExitCode::kDone);
  const Comparison both =
      compare_results({{changed, kReference}, {}}, {{kReference}, {}}, ComparisonOptions{});
  CHECK(both.verdict() == ExitCode::kDone);
  CHECK_THAT(both.moved.at(0), Contains("m:v*: not in the reference"));
}

TEST_CASE("A cell that fails is worse, one that no longer fails better") {
  const Comparison worse = compared(failed_cell(), kReference);
  CHECK(worse.verdict() == ExitCode::kWorse);
  CHECK_THAT(worse.worse.at(0), Contains("ok -> failed (no idea)"));
  const Comparison better = compared(kReference, failed_cell());
  CHECK(better.verdict() == ExitCode::kDone);
  CHECK_THAT(better.better.at(0), Contains("failed -> ok"));
  CHECK(compared(failed_cell(), failed_cell()).verdict() == ExitCode::kDone);
  // A sequence that cannot be read has no fingerprint; that is a failure, and no other data.
  ComparedCell unread = failed_cell();
  unread.identity.erase("data fingerprint");
  CHECK(compared(unread, kReference).verdict() == ExitCode::kWorse);
}

TEST_CASE("Controls that are off make a run worse and a reference useless") {
  const ResultSet sound{{kReference}, {}}, off{{kReference}, {"control 'noop' is off"}};
  CHECK(compare_results(off, sound, {}).verdict() == ExitCode::kWorse);
  CHECK(compare_results(sound, off, {}).verdict() == ExitCode::kCannotDo);
}

TEST_CASE("Time is told, and judged only beyond a band") {
  ComparedCell slow = kReference;
  slow.seconds_per_scan = 0.4;
  const Comparison told = compared(slow, kReference);
  CHECK(told.verdict() == ExitCode::kDone);
  CHECK_THAT(told.times.at(0), Contains("4.00 times the reference (400.0 ms per scan, was 100.0)"));
  CHECK(compared(slow, kReference, {{}, 3.0}).verdict() == ExitCode::kWorse);
  CHECK(compared(slow, kReference, {{}, 5.0}).verdict() == ExitCode::kDone);
  CHECK(compared(kReference, slow, {{}, 3.0}).verdict() == ExitCode::kDone);
  ComparedCell timeless = kReference;
  timeless.seconds_per_scan.reset();
  CHECK(compared(slow, timeless).verdict() == ExitCode::kDone);
  CHECK(compared(slow, timeless, {{}, 3.0}).verdict() == ExitCode::kCannotDo);
}

namespace {

ComparedCell with_tau0(ComparedCell cell, const std::string& value) {
  cell.identity["parameter tau0"] = value;
  return cell;
}

ComparisonOptions across_parameters(std::map<std::string, double> tolerances = {}) {
  ComparisonOptions options;
  options.tolerances = std::move(tolerances);
  options.across_parameters = true;
  return options;
}

}  // namespace

TEST_CASE("Across parameters rates are judged, and it is told which parameters differ") {
  // PR 99.0 -> 98.9, RR 90 -> 95: F1 = 2 PR RR / (PR + RR) rises from 0.9429 to 0.9691.
  const ComparedCell run = with_tau0(cell_with(989, 10), "0.4");
  CHECK(compared(run, kReference).verdict() == ExitCode::kCannotDo);
  CHECK(compared(run, kReference).parameters_only);
  const Comparison strict = compared(run, kReference, across_parameters());
  CHECK(strict.verdict() == ExitCode::kWorse);  // PR fell, and nothing says that it may.
  CHECK_THAT(strict.moved.at(0), Contains("parameter tau0 is 0.4, the reference has 0.3"));
  CHECK(strict.scores.at(0).across ==
        std::vector<std::string>{"parameter tau0 is 0.4, the reference has 0.3"});
  // Only F1 decides, and it rose; PR is reported.
  const Comparison f1 = compared(run, kReference, across_parameters({{"F1", 0.01}}));
  CHECK(f1.verdict() == ExitCode::kDone);
  CHECK_THAT(comparison_text(f1), Contains("PR 99.0000 -> 98.9000"));
  CHECK(compared(run, kReference, across_parameters({{"PR", 0.1}})).verdict() == ExitCode::kDone);
  CHECK(compared(run, kReference, across_parameters({{"PR", 0.09}})).verdict() == ExitCode::kWorse);
  // Every rate rose: better, though counts differ.
  const ComparedCell good = with_tau0(cell_with(991, 10), "0.4");
  const Comparison better = compared(good, kReference, across_parameters());
  CHECK(better.verdict() == ExitCode::kDone);
  CHECK(better.better.size() == 1);
}

TEST_CASE("What is worse does not hide that only parameters keep cells from being compared") {
  ResultSet run{{with_tau0(kReference, "0.4"), cell_with(989, 20, "other:v")}, {}};
  const ResultSet reference{{kReference, cell_with(990, 20, "other:v")}, {}};
  CHECK(compare_results(run, reference, {}).parameters_only);
  run.cells[1].identity["data fingerprint"] = "xyz";
  CHECK_FALSE(compare_results(run, reference, {}).parameters_only);
}

TEST_CASE("Across parameters, data, protocol and counts of the truth must be the same") {
  ComparedCell run = with_tau0(kReference, "0.4");
  run.identity["data fingerprint"] = "xyz";
  CHECK(compared(run, kReference, across_parameters()).verdict() == ExitCode::kCannotDo);
  CHECK_FALSE(compared(run, kReference).parameters_only);
  run = with_tau0(kReference, "0.4");
  run.scores[0].identity["option voxel_size"] = "0.1";
  CHECK(compared(run, kReference, across_parameters()).verdict() == ExitCode::kCannotDo);
  run = with_tau0(cell_with(991, 10), "0.4");
  run.scores[0].counts[0].second = 1001;
  CHECK(compared(run, kReference, across_parameters()).verdict() == ExitCode::kWorse);
}

TEST_CASE("Across versions rates are judged where the version differs") {
  ComparedCell run = cell_with(989, 10);
  run.method_version = "2";
  ComparisonOptions options;
  options.across_version = true;
  options.tolerances = {{"F1", 0.01}};
  CHECK(compared(run, kReference, options).verdict() == ExitCode::kDone);
  options.tolerances.clear();
  CHECK(compared(run, kReference, options).verdict() == ExitCode::kWorse);
  CHECK(compared(with_tau0(run, "0.4"), kReference, options).verdict() == ExitCode::kCannotDo);
  run = kReference;
  run.method_version = "2";
  run.scores[0].counts[4].second = 4999;
  CHECK(compared(run, kReference, options).verdict() == ExitCode::kDone);
  CHECK(compared(run, kReference).verdict() == ExitCode::kWorse);
}

TEST_CASE("A rate of which nobody knows the better direction is told and not judged") {
  ComparedCell reference = kReference;
  reference.scores[0].rates.push_back({"spread", 3.0, ""});
  for (const double value : {2.0, 4.0}) {
    ComparedCell run = with_tau0(reference, "0.4");
    run.scores[0].rates[3].value = value;
    const Comparison result = compared(run, reference, across_parameters());
    CHECK(result.verdict() == ExitCode::kDone);
    CHECK(result.better.empty());
    CHECK_THAT(comparison_text(result), Contains("spread 3.0000 -> "));
    CHECK(result.scores.at(0).change == Change::kMoved);
  }
  CHECK_THROWS_AS(compared(reference, reference, {{{"spread", 1.0}}, {}}), UsageError);
}

TEST_CASE("A reference without times is told once where times are to be judged") {
  ComparedCell timeless = kReference, other = cell_with(500, 100, "other:v");
  timeless.seconds_per_scan.reset();
  const ComparedCell timed_other = other;
  other.seconds_per_scan.reset();
  const Comparison result =
      compare_results({{kReference, timed_other}, {}}, {{timeless, other}, {}}, {{}, 3.0});
  CHECK(result.verdict() == ExitCode::kCannotDo);
  REQUIRE(result.incomparable.size() == 1);
  CHECK_THAT(result.incomparable[0], Contains("--update --with-times"));
  // One cell of several without a time is reported with its name.
  const Comparison one =
      compare_results({{kReference, timed_other}, {}}, {{kReference, other}, {}}, {{}, 3.0});
  CHECK(one.verdict() == ExitCode::kCannotDo);
  CHECK_THAT(one.incomparable.at(0), Contains("other:v"));
  CHECK(one.time_changes.size() == 2);
}

TEST_CASE("Times of cells that ran at once are compared only with those of as many at once") {
  ComparedCell beside = kReference;
  beside.side_by_side = 2;
  beside.seconds_per_scan = 0.9;  // Nine times the reference's.
  const Comparison shown = compared(beside, kReference);
  CHECK(shown.verdict() == ExitCode::kDone);
  REQUIRE(shown.times.size() == 1);
  CHECK_THAT(shown.times[0], Contains("not compared") && Contains("2 cells at once") &&
                                 Contains("the reference with 1"));
  ComparisonOptions judging;
  judging.time_band = 3.0;
  const Comparison asked = compared(beside, kReference, judging);
  CHECK(asked.verdict() == ExitCode::kCannotDo);
  CHECK_THAT(asked.incomparable.at(0), Contains("not taken alike") && Contains("--time-band"));
  CHECK(compared(kReference, beside, judging).verdict() == ExitCode::kCannotDo);
  ComparedCell also_beside = kReference;
  also_beside.side_by_side = 2;
  CHECK(compared(beside, also_beside, judging).verdict() == ExitCode::kWorse);
  beside.seconds_per_scan = 0.2;
  CHECK(compared(beside, also_beside, judging).verdict() == ExitCode::kDone);
}
