// SPDX-License-Identifier: MIT
#include "eval/confidence/reliability.h"

#include <catch2/catch.hpp>

#include "core/error.h"
#include "eval/scan_passes.h"
#include "tests/eval/memory_sequence.h"

namespace raymoval::test {
namespace {

/// Two scans: 40 stays, 252 moves, 99 is ignored.
MemorySequence said_drive() {
  LabelledScan first;
  first.add(5.0f, 0.0f, 0.0f, 40);
  first.add(6.0f, 0.0f, 0.0f, 252);
  first.add(60.0f, 0.0f, 0.0f, 252);  // Out of range.
  first.add(7.0f, 0.0f, 0.0f, 99);    // Ignored.
  LabelledScan second;
  second.add(1.0f, 0.0f, 0.0f, 252);  // Near points count.
  second.add(8.0f, 0.0f, 0.0f, 40);
  return MemorySequence({first, second});
}

/// @param scans the steps of each scan's points
ConfidenceStore confidence_of(const std::vector<std::vector<int>>& scans) {
  ConfidenceStore store;
  for (const std::vector<int>& steps : scans) store.steps.append({steps.begin(), steps.end()});
  return store;
}

}  // namespace

TEST_CASE("points are counted by what was said of them, and by what moves") {
  const MemorySequence drive = said_drive();
  EvaluationInput input = drive.input();
  input.range_m = {0.0, 50.0};
  input.label_rule.ignored = {99};
  // 250 steps are 1: 24 of them lie below 0.1, and 25 do not.
  const ConfidenceStore said = confidence_of({{24, 250, 250, 250}, {225, 25}});
  for (const int threads : {1, 2}) {
    input.threads = threads;
    ReliabilityCount count(input, said);
    run_passes(input, drive.masks(), {&count});
    const auto& bins = count.reliability().bins;
    CHECK(bins[0].points == 1);
    CHECK(bins[0].moving == 0);
    CHECK(bins[0].steps == 24);
    CHECK(bins[1].points == 1);
    CHECK(bins[1].moving == 0);
    CHECK(bins[9].points == 2);
    CHECK(bins[9].moving == 2);
    CHECK(bins[9].mean_confidence() == Approx(0.95));  // (1 + 0.9) / 2.
    CHECK_FALSE(bins[5].moving_share());
    // Gaps of 0.096, 0.1 and twice 0.05, over four points.
    CHECK(count.reliability().expected_error() == Approx((0.096 + 0.1 + 0.1) / 4));
    CHECK_FALSE(count.reliability().mean_gap());  // No bin has 100 points.
  }
}

TEST_CASE("the mean gap is over bins alike, and leaves out those of few points") {
  Reliability reliability;
  reliability.bins[0] = {900, 0, 0};           // Said 0, and none moves.
  reliability.bins[4] = {100, 60, 100 * 100};  // Said 0.4, and 0.6 move.
  reliability.bins[9] = {99, 0, 99 * 250};     // Wrong, but few.
  CHECK(reliability.mean_gap() == Approx(0.1));
  CHECK(reliability.expected_error() == Approx((100 * 0.2 + 99) / 1099.0));
  CHECK_FALSE(Reliability().expected_error());
}

TEST_CASE("a confidence that does not fit the scans is an error") {
  const MemorySequence drive = said_drive();
  const EvaluationInput input = drive.input();
  CHECK_THROWS_AS(ReliabilityCount(input, confidence_of({{1, 2, 3, 4}})), MethodError);
  const ConfidenceStore short_scan = confidence_of({{1, 2, 3}, {1, 2}});
  ReliabilityCount count(input, short_scan);
  CHECK_THROWS_WITH(run_passes(input, drive.masks(), {&count}),
                    Catch::Matchers::Contains("3 points of scan 0"));
}

}  // namespace raymoval::test
