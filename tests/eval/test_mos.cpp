// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "core/error.h"
#include "tests/eval/memory_sequence.h"

namespace raymoval::test {
namespace {

constexpr std::uint32_t kRoad = 40, kMovingCar = 252;

ProtocolResult scored(const MemorySequence& sequence, const MaskStore& masks,
                      const LabelRule& rule = {}, bool ignore_unlabelled = true) {
  Configuration options = protocol_defaults("mos");
  set_parameter(options, "ignore_unlabelled", ignore_unlabelled);
  EvaluationInput input = sequence.input();
  input.label_rule = rule;
  input.range_m = {1.0, 50.0};
  return make_protocol("mos", options)->open(input)->score(masks);
}

/// 5 moving points, 3 of them flagged; 7 of the road, 1 of them flagged; in two scans.
MemorySequence two_scans() {
  LabelledScan first, second;
  for (int i = 0; i < 3; ++i) first.add(5.0F + static_cast<float>(i), 0, 0, kMovingCar, i < 2);
  for (int i = 0; i < 4; ++i) first.add(9.0F + static_cast<float>(i), 0, 0, kRoad, i == 0);
  for (int i = 0; i < 2; ++i) second.add(5.0F + static_cast<float>(i), 0, 0, kMovingCar, i < 1);
  for (int i = 0; i < 3; ++i) second.add(9.0F + static_cast<float>(i), 0, 0, kRoad);
  second.pose.translation().x() = 100.0;  // Where the scan was taken is no matter.
  return MemorySequence({first, second});
}

}  // namespace

TEST_CASE("mos: rates of the moving class over the sums of all scans") {
  const MemorySequence sequence = two_scans();
  const ProtocolResult result = scored(sequence, sequence.masks());
  CHECK(result.count("dynamic_points") == 5);
  CHECK(result.count("static_points") == 7);
  CHECK(result.count("flagged_dynamic_points") == 3);
  CHECK(result.count("kept_static_points") == 6);
  CHECK(*result.rate("precision") == Approx(100.0 * 3 / 4));
  CHECK(*result.rate("recall") == Approx(100.0 * 3 / 5));
  CHECK(*result.rate("IoU") == Approx(100.0 * 3 / 6));
}

TEST_CASE("mos: counts of each scan are told, too") {
  const MemorySequence sequence = two_scans();
  const CountsByScan expected = {{"flagged_dynamic_points", {2, 1}},
                                 {"dynamic_points", {3, 2}},
                                 {"kept_static_points", {3, 3}},
                                 {"static_points", {4, 3}}};
  CHECK(scored(sequence, sequence.masks()).by_scan == expected);
}

TEST_CASE("mos: answers whose rates are known") {
  const MemorySequence sequence = two_scans();
  const ProtocolResult oracle = scored(sequence, sequence.oracle_masks());
  CHECK(*oracle.rate("IoU") == 100.0);
  const ProtocolResult nothing = scored(sequence, sequence.constant_masks(false));
  CHECK(*nothing.rate("IoU") == 0.0);
  CHECK(*nothing.rate("recall") == 0.0);
  CHECK_FALSE(nothing.rate("precision").has_value());
  const ProtocolResult everything = scored(sequence, sequence.constant_masks(true));
  CHECK(*everything.rate("IoU") == Approx(100.0 * 5 / 12));
  CHECK(*everything.rate("precision") == Approx(100.0 * 5 / 12));
  CHECK(*everything.rate("recall") == 100.0);
}

TEST_CASE("mos: ignored, unlabelled and far points are on neither side") {
  LabelledScan scan;
  scan.add(5, 0, 0, kMovingCar, true);
  scan.add(6, 0, 0, 0, true);                  // Unlabelled.
  scan.add(7, 0, 0, 1, true);                  // An outlier.
  scan.add(8, 0, 0, 99, true);                 // Ignored by the rule.
  scan.add(0.5F, 0, 0, kRoad, true);           // Too near.
  scan.add(60, 0, 0, kMovingCar, false);       // Too far.
  scan.add(9, 0, 0, kRoad | 0x70000U, false);  // The upper half of a word is no class.
  const MemorySequence sequence({scan});
  LabelRule rule;
  rule.ignored = {99};
  const ProtocolResult result = scored(sequence, sequence.masks(), rule);
  CHECK(result.count("ignored_points") == 3);
  CHECK(result.count("out_of_range_points") == 2);
  CHECK(result.count("static_points") == 1);
  CHECK(*result.rate("IoU") == 100.0);
  const ProtocolResult with_unlabelled = scored(sequence, sequence.masks(), rule, false);
  CHECK(with_unlabelled.count("static_points") == 3);
  CHECK(*with_unlabelled.rate("IoU") == Approx(100.0 / 3));
}

TEST_CASE("mos: without a moving point nothing is said, and without any point it is an error") {
  LabelledScan scan;
  scan.add(5, 0, 0, kRoad, true);
  const MemorySequence standing({scan});
  const ProtocolResult result = scored(standing, standing.masks());
  CHECK_FALSE(result.rate("IoU").has_value());
  CHECK_FALSE(result.rate("recall").has_value());
  CHECK(*result.rate("precision") == 0.0);
  LabelledScan unlabelled;
  unlabelled.add(5, 0, 0, 0, true);
  const MemorySequence none({unlabelled});
  CHECK_THROWS_AS(scored(none, none.masks()), DataError);
}

}  // namespace raymoval::test
