// SPDX-License-Identifier: MIT
// SA, DA, AA and HA over points, and over sets of cells.
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "core/error.h"
#include "tests/eval/memory_sequence.h"
#include "tests/eval/random_sequence.h"
#include "tests/eval/worked_example.h"

namespace raymoval::test {
namespace {

using Catch::Contains;

ProtocolResult score_scan(const LabelledScan& scan, const Settings& settings = {},
                          const std::string& protocol = "dynamicmap") {
  const MemorySequence sequence({scan});
  return score_by(protocol, sequence.input(), sequence.masks(), settings);
}

/// Every pair of points, and nothing shared with eval/: present static and gone dynamic points.
std::pair<std::int64_t, std::int64_t> slow_presence(const EvaluationInput& input,
                                                    const MemorySequence& sequence,
                                                    double distance) {
  struct Point {
    Eigen::Vector3d at;
    LabelClass label_class;
    bool removed;
  };
  std::vector<Point> points;
  for (const LabelledScan& scan : sequence.scans()) {
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const Eigen::Vector3d p = scan.points[i].cast<double>();
      if (p.norm() < input.range_m.min || p.norm() > input.range_m.max) continue;
      points.push_back(
          {scan.pose * p, input.label_rule.classify(scan.labels[i]), scan.mask[i] != 0});
    }
  }
  std::pair<std::int64_t, std::int64_t> counts = {0, 0};
  for (const Point& point : points) {
    if (point.label_class == LabelClass::kIgnored) continue;
    const bool present = std::any_of(points.begin(), points.end(), [&](const Point& other) {
      return !other.removed && (other.at - point.at).norm() <= distance;
    });
    if (point.label_class == LabelClass::kStatic && present) ++counts.first;
    if (point.label_class == LabelClass::kMoving && !present) ++counts.second;
  }
  return counts;
}

EvaluationInput input_of(const MemorySequence& sequence) {
  EvaluationInput input = sequence.input();
  input.range_m = {3.0, 4.9};  // No point is near enough to be the ego vehicle.
  input.label_rule.ignored = {99};
  return input;
}

}  // namespace

TEST_CASE("the worked example scores by points as written", "[dynamicmap][worked]") {
  const MemorySequence sequence = worked_example();
  const ProtocolResult result = score_by("dynamicmap", sequence.input(), sequence.masks());
  CHECK(result.count("static_points") == 8);
  CHECK(result.count("dynamic_points") == 4);
  // Points 1, 6, 8 and 10 are kept; 2 is present because 10 is 0.0283 m away.
  CHECK(result.count("kept_static_points") == 4);
  CHECK(result.count("present_static_points") == 5);
  CHECK(result.count("removed_dynamic_points") == 3);  // 4, 5, 9.
  CHECK(result.count("flagged_dynamic_points") == 3);
  CHECK(result.rate("SA") == 62.5);
  CHECK(result.rate("DA") == 75.0);
  CHECK(result.rate("AA").value() == Approx(68.4653).margin(5e-5));
  CHECK(result.rate("HA").value() == Approx(68.1818).margin(5e-5));
  CHECK(result.warnings.empty());
}

TEST_CASE("the worked example scores by sets of cells", "[dynamicmap][worked]") {
  const MemorySequence sequence = worked_example();
  // Cells of 0.1 m: the static points 2 and 10 share one, so do the moving ones 4 and 5. Of the
  // static cells {1} {2 10} {3} {6} {7} {8} {11} four keep a static point (1, 10, 6, 8); of the
  // dynamic ones {4 5} {9} {12} only that of 12 keeps one.
  const ProtocolResult fine = score_by("dynamicmap-strict", sequence.input(), sequence.masks());
  CHECK(fine.count("static_voxels") == 7);
  CHECK(fine.count("dynamic_voxels") == 3);
  CHECK(fine.count("preserved_static") == 4);
  CHECK(fine.count("remaining_dynamic") == 1);
  CHECK(fine.count("mixed_voxels") == 0);
  CHECK(fine.rate("SA").value() == Approx(400.0 / 7));
  CHECK(fine.rate("DA").value() == Approx(200.0 / 3));
  CHECK(fine.rate("AA").value() == Approx(100.0 * std::sqrt(8.0 / 21)));
  CHECK(fine.rate("HA").value() == Approx(100.0 * 8.0 / 13));  // 2 (4/7)(2/3) / (4/7 + 2/3).
  // Cells of 0.2 m: 3 joins 2 and 10, and 6 is in the cell of 4 and 5, which is still cleared of
  // moving points.
  const ProtocolResult coarse =
      score_by("dynamicmap-strict", sequence.input(), sequence.masks(), {{"voxel_size", 0.2}});
  CHECK(coarse.count("static_voxels") == 6);
  CHECK(coarse.count("preserved_static") == 4);
  CHECK(coarse.count("mixed_voxels") == 1);
  CHECK(coarse.count("remaining_dynamic") == 1);
}

TEST_CASE("a point at exactly the distance is present, one beyond is gone", "[dynamicmap]") {
  // Kept at x = 8; removed ones 0.0625 m away (exact in binary) and a little more.
  LabelledScan scan;
  scan.add(8.0f, 0.0f, 0.0f, 40);
  scan.add(8.0625f, 0.0f, 0.0f, 40, true);
  scan.add(8.0f, -0.0625f, 0.0f, 252, true);
  scan.add(7.9374995f, 0.0f, 0.0f, 40, true);
  const ProtocolResult result = score_scan(scan, {{"distance", 0.0625}});
  CHECK(result.count("present_static_points") == 2);
  CHECK(result.count("removed_dynamic_points") == 0);
  CHECK(score_scan(scan, {{"distance", 0.0}}).count("present_static_points") == 1);
}

TEST_CASE("ignored points are in no denominator, but may stand in the map", "[dynamicmap]") {
  LabelledScan scan;
  scan.add(8.0f, 0.0f, 0.0f, 40);
  scan.add(12.0f, 0.0f, 0.0f, 252, true);
  scan.add(12.0f, 0.0f, 0.04f, 0);
  scan.add(16.0f, 0.0f, 0.0f, 0, true);
  const MemorySequence sequence({scan});
  EvaluationInput input = sequence.input();
  input.label_rule.ignored = {0};
  const ProtocolResult result = score_by("dynamicmap", input, sequence.masks());
  CHECK(result.count("static_points") == 1);
  CHECK(result.count("dynamic_points") == 1);
  CHECK(result.count("ignored_points") == 2);
  CHECK(result.rate("DA") == 0.0);
  CHECK(score_by("dynamicmap", input, sequence.masks(), {{"ignored_in_estimate", false}})
            .rate("DA") == 100.0);
  CHECK(score_by("dynamicmap-strict", input, sequence.masks()).rate("DA") == 100.0);
}

TEST_CASE("unlabelled points near the sensor are the ego vehicle", "[dynamicmap]") {
  LabelledScan scan;
  scan.add(2.0f, 0.0f, 0.0f, 0);        // Ego.
  scan.add(0.0f, 2.0f, 1.0f, 1);        // Ego.
  scan.add(2.0f, 2.0f, 1.0f, 0);        // At exactly 3 m: not nearer.
  scan.add(0.0f, 0.0f, -1.7f, 40);      // Near, but labelled.
  scan.add(10.0f, 0.0f, 0.0f, 0);       // Far.
  scan.add(0.0f, 12.0f, 0.0f, 327933);  // 253 of instance 5.
  const ProtocolResult result = score_scan(scan);
  CHECK(result.count("ego_points") == 2);
  CHECK(result.count("dynamic_points") == 3);
  CHECK(result.count("static_points") == 3);
  CHECK(score_scan(scan, {{"ego_range", 0.0}}).count("dynamic_points") == 1);
  // Where 0 and 1 are the classes themselves, nothing is relabelled.
  const MemorySequence sequence({scan});
  EvaluationInput input = sequence.input();
  input.label_rule.moving = {1};
  const ProtocolResult plain = score_by("dynamicmap", input, sequence.masks());
  CHECK(plain.count("ego_points") == 0);
  CHECK(plain.count("dynamic_points") == 1);
}

TEST_CASE("the maximum range is strict and on both sides", "[dynamicmap]") {
  LabelledScan scan;
  scan.add(49.99f, 0.0f, 0.0f, 40, true);
  scan.add(50.0f, 0.0f, 0.0f, 40);  // Would keep its neighbour present.
  scan.add(20.0f, 0.0f, 0.0f, 252);
  const ProtocolResult limited = score_scan(scan, {{"maximum_range", 50.0}});
  CHECK(limited.count("static_points") == 1);
  CHECK(limited.count("out_of_range_points") == 1);
  CHECK(limited.rate("SA") == 0.0);
  const ProtocolResult open = score_scan(scan);
  CHECK(open.count("static_points") == 2);
  CHECK(open.rate("SA") == 100.0);
}

TEST_CASE("no static or no dynamic point: undefined, with a reason", "[dynamicmap][edge]") {
  for (const char* protocol : {"dynamicmap", "dynamicmap-strict"}) {
    LabelledScan still;
    still.add(8.0f, 0.0f, 0.0f, 40);
    still.add(9.0f, 0.0f, 0.0f, 40, true);
    const ProtocolResult no_dynamic = score_scan(still, {}, protocol);
    CHECK(no_dynamic.rate("SA") == 50.0);
    for (const char* rate : {"DA", "AA", "HA"}) {
      CHECK_FALSE(no_dynamic.rate(rate).has_value());
      CHECK_THAT(rate_named(no_dynamic, rate).undefined_reason, Contains("no dynamic"));
    }
    LabelledScan moving;
    moving.add(8.0f, 0.0f, 0.0f, 252, true);
    const ProtocolResult no_static = score_scan(moving, {}, protocol);
    CHECK(no_static.rate("DA") == 100.0);
    CHECK_FALSE(no_static.rate("HA").has_value());
    CHECK_THAT(rate_named(no_static, "SA").undefined_reason, Contains("no static"));
  }
}

TEST_CASE("an empty estimate scores 0 and 100, and no point at all is an error",
          "[dynamicmap][edge]") {
  LabelledScan scan;
  scan.add(8.0f, 0.0f, 0.0f, 40, true);
  scan.add(9.0f, 0.0f, 0.0f, 252, true);
  for (const char* protocol : {"dynamicmap", "dynamicmap-strict"}) {
    const ProtocolResult result = score_scan(scan, {}, protocol);
    CHECK(result.rate("SA") == 0.0);
    CHECK(result.rate("DA") == 100.0);
    CHECK(result.rate("AA") == 0.0);
    CHECK(result.rate("HA") == 0.0);
    REQUIRE(result.warnings.size() == 1);
    CHECK_THAT(result.warnings[0], Contains("empty"));
    const MemorySequence none(std::vector<LabelledScan>{});
    CHECK_THROWS_AS(score_by(protocol, none.input(), none.masks()), DataError);
    const MemorySequence two({scan, scan});
    CHECK_THROWS_AS(score_by(protocol, two.input(), MaskStore(1)), MethodError);
    CHECK_THROWS_AS(score_by(protocol, two.input(), MaskStore(2)), MethodError);
  }
}

TEST_CASE("random clouds have the presence that all pairs say", "[dynamicmap][oracle]") {
  for (unsigned seed = 0; seed < 12; ++seed) {
    CloudShape shape;
    shape.seed = seed;
    shape.points = 300;
    shape.extent = 0.5f;
    if (seed % 3 == 2) shape.coordinates = Coordinates::kOnWalls;
    if (seed >= 9) shape.offset = {100000.0, -100000.0, 1000.0};
    const MemorySequence sequence = random_sequence(shape);
    const EvaluationInput input = input_of(sequence);
    // With 40 % flagged those stay in memory; turned round, the kept ones do.
    MaskStore flipped(sequence.size());
    std::vector<LabelledScan> other = sequence.scans();
    for (std::size_t i = 0; i < other.size(); ++i) {
      for (std::uint8_t& flag : other[i].mask) flag = flag != 0 ? 0 : 1;
      flipped.set(i, other[i].mask);
    }
    for (const double distance : {0.05, 0.0625, 0.4}) {
      CAPTURE(seed, distance);
      const auto [present, gone] = slow_presence(input, sequence, distance);
      const ProtocolResult fast =
          score_by("dynamicmap", input, sequence.masks(), {{"distance", distance}});
      CHECK(fast.count("present_static_points") == present);
      CHECK(fast.count("removed_dynamic_points") == gone);
      const auto [other_present, other_gone] =
          slow_presence(input, MemorySequence(other), distance);
      const ProtocolResult turned =
          score_by("dynamicmap", input, flipped, {{"distance", distance}});
      CHECK(turned.count("present_static_points") == other_present);
      CHECK(turned.count("removed_dynamic_points") == other_gone);
    }
  }
}

TEST_CASE("controls, threads and the order of points, by points and by cells", "[dynamicmap]") {
  CloudShape shape;
  shape.scans = 9;
  shape.points = 4000;
  const MemorySequence sequence = random_sequence(shape);
  EvaluationInput input = input_of(sequence);
  std::vector<LabelledScan> scans = sequence.scans();
  std::mt19937 random(7);
  for (LabelledScan& scan : scans) scan = shuffled(scan, random);
  std::reverse(scans.begin(), scans.end());
  const MemorySequence other(scans);
  for (const char* protocol : {"dynamicmap", "dynamicmap-strict"}) {
    CAPTURE(protocol);
    input.threads = 1;
    const ProtocolResult one = score_by(protocol, input, sequence.masks());
    for (const int threads : {2, 8}) {
      input.threads = threads;
      CHECK(score_by(protocol, input, sequence.masks()).counts == one.counts);
    }
    CHECK(score_by(protocol, input_of(other), other.masks()).counts == one.counts);
    const ProtocolResult noop = score_by(protocol, input, sequence.constant_masks(false));
    CHECK(noop.rate("SA") == 100.0);
    CHECK(noop.rate("DA") == 0.0);
    CHECK(noop.rate("HA") == 0.0);
    const ProtocolResult all = score_by(protocol, input, sequence.constant_masks(true));
    CHECK(all.rate("SA") == 0.0);
    CHECK(all.rate("DA") == 100.0);
    const ProtocolResult oracle =
        score_by(protocol, input, sequence.oracle_masks(input.label_rule));
    CHECK(oracle.rate("SA") == 100.0);
  }
  const ProtocolResult strict =
      score_by("dynamicmap-strict", input, sequence.oracle_masks(input.label_rule));
  CHECK(strict.rate("DA") == 100.0);
}

}  // namespace raymoval::test
