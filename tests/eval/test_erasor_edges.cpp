// SPDX-License-Identifier: MIT
// Edge cases of the ERASOR protocol, one scene each.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/error.h"
#include "eval/points/cloud_masks.h"
#include "tests/datasets/temporary_folder.h"
#include "tests/eval/memory_sequence.h"

namespace raymoval::test {
namespace {

using Catch::Contains;

/// A scan of single points two metres apart from x = 5 on, each its own voxel.
LabelledScan row_of(const std::vector<std::pair<std::uint32_t, bool>>& points) {
  LabelledScan scan;
  float x = 5.05f;
  for (const auto& [label, flagged] : points) {
    scan.add(x, 0.05f, -1.63f, label, flagged);
    x += 2.0f;
  }
  return scan;
}

ProtocolResult score_row(const std::vector<std::pair<std::uint32_t, bool>>& points,
                         const Settings& settings = {}) {
  const MemorySequence sequence({row_of(points)});
  return score_erasor(sequence.input(), sequence.masks(), settings);
}

}  // namespace

TEST_CASE("nothing dynamic: RR and F1 are undefined, PR is not", "[erasor][edge]") {
  const ProtocolResult result = score_row({{40, false}, {40, true}, {50, false}});
  CHECK(result.rate("PR").value() == Approx(200.0 / 3));
  CHECK_FALSE(result.rate("RR").has_value());
  CHECK_FALSE(result.rate("F1").has_value());
  CHECK_THAT(rate_named(result, "RR").undefined_reason, Contains("no dynamic voxel"));
  CHECK_THAT(rate_named(result, "F1").undefined_reason, Contains("no dynamic voxel"));
  CHECK(rate_named(result, "PR").undefined_reason.empty());
}

TEST_CASE("nothing static: PR and F1 are undefined, RR is not", "[erasor][edge]") {
  const ProtocolResult result = score_row({{252, false}, {254, true}});
  CHECK_FALSE(result.rate("PR").has_value());
  CHECK(result.rate("RR") == 50.0);
  CHECK_FALSE(result.rate("F1").has_value());
  CHECK_THAT(rate_named(result, "F1").undefined_reason, Contains("no static voxel"));
}

TEST_CASE("an empty estimate scores 0, 100, 0 with a warning", "[erasor][edge]") {
  for (const char* mode : {"index", "nearest"}) {
    const ProtocolResult result =
        score_row({{40, true}, {252, true}}, {{"label_mode", std::string(mode)}});
    CHECK(result.rate("PR") == 0.0);
    CHECK(result.rate("RR") == 100.0);
    CHECK(result.rate("F1") == 0.0);
    REQUIRE(result.warnings.size() == 1);
    CHECK_THAT(result.warnings[0], Contains("empty"));
  }
}

TEST_CASE("no truth is an error that says where the points went", "[erasor][edge]") {
  LabelledScan scan;
  scan.add(1.0f, 0.0f, 0.0f, 40);   // Cropped.
  scan.add(10.0f, 0.0f, 0.0f, 99);  // Ignored.
  scan.add(60.0f, 0.0f, 0.0f, 40);  // Out of range.
  scan.add(61.0f, 0.0f, 0.0f, 99);  // Out of range first.
  const MemorySequence sequence({scan});
  EvaluationInput input = sequence.input();
  input.range_m = {0.0, 50.0};
  input.label_rule.ignored = {99};
  const std::string message = message_of<DataError>([&] { score_erasor(input, sequence.masks()); });
  CHECK_THAT(message, Contains("2 are out of range") && Contains("1 have ignored labels") &&
                          Contains("1 lie too near"));
  const MemorySequence empty(std::vector<LabelledScan>{});
  CHECK_THROWS_AS(score_erasor(empty.input(), empty.masks()), DataError);
}

TEST_CASE("a mask that does not fit its scan is the method's error", "[erasor][edge]") {
  const MemorySequence sequence({row_of({{40, false}, {252, true}, {40, false}})});
  MaskStore wrong(1);
  wrong.set(0, Mask(5, 0));
  const std::string message =
      message_of<MethodError>([&] { score_erasor(sequence.input(), wrong); });
  CHECK_THAT(message, Contains("5 values") && Contains("3 points") && Contains("frame 0"));
  CHECK_THROWS_AS(score_erasor(sequence.input(), MaskStore(1)), MethodError);
  CHECK_THROWS_AS(score_erasor(sequence.input(), MaskStore(2)), MethodError);
  // A scan without points has a mask without values, and not none.
  const MemorySequence with_empty({row_of({{40, false}, {252, true}}), LabelledScan{}});
  MaskStore masks(2);
  masks.set(0, {0, 1});
  CHECK_THAT(message_of<MethodError>([&] { score_erasor(with_empty.input(), masks); }),
             Contains("scan 1 (frame 1) has no mask"));
  masks.set(1, {});
  CHECK(score_erasor(with_empty.input(), masks).rate("RR") == 100.0);
}

TEST_CASE("labels that do not fit their scan are a data error", "[erasor][edge]") {
  LabelledScan scan = row_of({{40, false}, {252, true}});
  scan.labels.pop_back();
  const MemorySequence sequence({scan});
  const std::string message =
      message_of<DataError>([&] { (void)erasor_protocol()->open(sequence.input()); });
  CHECK_THAT(message, Contains("1 labels") && Contains("2 points"));
  EvaluationInput unlabelled = sequence.input();
  unlabelled.labels = nullptr;
  CHECK_THROWS_AS(erasor_protocol()->open(unlabelled), DataError);
}

TEST_CASE("of two equally near partners the first in cell order counts", "[erasor][edge]") {
  // Cells of 0.25 m. The flagged static point in the middle has one kept point 0.15625 m below it
  // in y and one as far above it in x. Cells run along x first, so the one lower in y comes first.
  for (const bool moving_below : {true, false}) {
    LabelledScan scan;
    scan.add(5.125f, 0.125f, 0.125f, 40, true);
    scan.add(5.125f, -0.03125f, 0.125f, moving_below ? 252 : 40, false);
    scan.add(5.28125f, 0.125f, 0.125f, moving_below ? 40 : 252, false);
    const MemorySequence sequence({scan});
    const ProtocolResult result =
        score_erasor(sequence.input(), sequence.masks(), {{"voxel_size", 0.25}, {"lift", 0.0}});
    CHECK(result.count("static_voxels") == 2);
    CHECK(result.count("preserved_static") == (moving_below ? 1 : 2));
    CHECK(result.count("remaining_dynamic") == 1);
  }
}

TEST_CASE("the crop is strict and looks at x and y only", "[erasor][edge]") {
  // (1.5, 2.0) is exactly 2.5 m from the axis and is kept; nearer points are cropped, at any z.
  LabelledScan scan;
  scan.add(1.5f, 2.0f, 0.0f, 40);
  scan.add(std::nextafter(1.5f, 0.0f), 2.0f, 9.0f, 40);
  const MemorySequence sequence({scan});
  const ProtocolResult result =
      score_erasor(sequence.input(), sequence.masks(), {{"minimum_horizontal_range", 2.5}});
  CHECK(result.count("evaluated_points") == 1);
  CHECK(result.count("cropped_points") == 1);
  // At the default of 2.7 m: the float below 2.7 is cropped, the one above stays.
  LabelledScan edge;
  edge.add(std::nextafter(2.7f, 0.0f), 0.0f, 0.0f, 40);
  edge.add(2.7f, 0.0f, 0.0f, 40);  // 2.7000000477.
  const MemorySequence edges({edge});
  CHECK(score_erasor(edges.input(), edges.masks()).count("cropped_points") == 1);
}

TEST_CASE("range limits include both ends", "[erasor][edge]") {
  LabelledScan scan;
  for (const float x : {3.0f, 5.0f, std::nextafter(3.0f, 0.0f), std::nextafter(5.0f, 9.0f)}) {
    scan.add(x, 0.0f, 0.0f, 40);
  }
  const MemorySequence sequence({scan});
  EvaluationInput input = sequence.input();
  input.range_m = {3.0, 5.0};
  const ProtocolResult result = score_erasor(input, sequence.masks());
  CHECK(result.count("evaluated_points") == 2);
  CHECK(result.count("out_of_range_points") == 2);
}

TEST_CASE("the lift is applied in the sensor frame, before the pose", "[erasor][edge]") {
  // The sensor lies on its side: its z axis is the world's y axis. (5, 0, 0) lifted by 1 m is
  // (5, 1, 0) in the world. Lifted after the pose the two scans would not meet.
  LabelledScan tilted, level;
  tilted.pose.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  tilted.add(5.05f, 0.05f, 0.05f, 40, true);   // World: 5.05, 1.05, -0.05.
  level.add(5.05f, 1.05f, -1.05f, 40, false);  // World: 5.05, 1.05, -0.05.
  const MemorySequence sequence({tilted, level});
  const ProtocolResult result = score_erasor(sequence.input(), sequence.masks(), {{"lift", 1.0}});
  CHECK(result.count("static_voxels") == 1);
  CHECK(result.count("preserved_static") == 1);
}

TEST_CASE("trucks are counted both ways when they occur", "[erasor][edge]") {
  // Static kept; truck kept; truck removed; car removed.
  const std::vector<std::pair<std::uint32_t, bool>> points = {
      {40, false}, {258, false}, {258, true}, {252, true}};
  const ProtocolResult with = score_row(points);
  CHECK(with.count("static_voxels") == 1);
  CHECK(with.count("dynamic_voxels") == 3);
  CHECK(with.count("remaining_dynamic") == 1);
  // Without 258 both truck voxels are static, and one of them is lost.
  CHECK(with.count("static_voxels_no_truck") == 3);
  CHECK(with.count("dynamic_voxels_no_truck") == 1);
  CHECK(with.count("preserved_static_no_truck") == 2);
  CHECK(with.count("remaining_dynamic_no_truck") == 0);
  CHECK(with.rate("PR_no_truck").value() == Approx(200.0 / 3));
  CHECK(with.rate("RR_no_truck") == 100.0);
  const ProtocolResult without = score_row(points, {{"truck_is_moving", false}});
  CHECK(without.count("static_voxels") == 3);
  CHECK(without.count("preserved_static") == 2);
  CHECK_THROWS_AS(without.count("static_voxels_no_truck"), InternalError);
  // Without trucks, there are no such counts.
  CHECK_THROWS_AS(score_row({{40, false}, {252, true}}).count("static_voxels_no_truck"),
                  InternalError);
}

TEST_CASE("labels 0, 1 and 251 are static, and 0 and 1 can be left out of PR", "[erasor][edge]") {
  const std::vector<std::pair<std::uint32_t, bool>> points = {
      {0, true}, {1, false}, {251, false}, {40, false}, {252, true}};
  const ProtocolResult kept = score_row(points);
  CHECK(kept.count("static_voxels") == 4);
  CHECK(kept.count("dynamic_voxels") == 1);
  CHECK(kept.count("unlabelled_voxels") == 2);
  CHECK(kept.rate("PR") == 75.0);
  const ProtocolResult left_out = score_row(points, {{"ignore_0_1", true}});
  CHECK(left_out.count("static_voxels") == 2);
  CHECK(left_out.rate("PR") == 100.0);
  CHECK(left_out.count("dynamic_voxels") == 1);
}

/// A sequence whose poses change after it was opened.
class MovedSequence : public MemorySequence {
 public:
  using MemorySequence::MemorySequence;
  [[nodiscard]] Scan load(std::size_t index) const override {
    Scan scan = MemorySequence::load(index);
    scan.T_world_sensor.translation().y() += shift;
    return scan;
  }
  double shift = 0.0;
};

TEST_CASE("an estimate beside its truth gives a warning", "[erasor][edge]") {
  // The cloud is the truth, moved by 0.15 m: every voxel has a partner (0.15 < 0.173) and none is
  // as near as half an edge, 0.1 m.
  const MemorySequence sequence({row_of({{40, false}, {40, false}, {252, false}})});
  const auto scorer = erasor_protocol({{"label_mode", std::string("nearest")}, {"lift", 0.0}})
                          ->open(sequence.input());
  for (const float shift : {0.05f, 0.15f, 0.30f}) {
    CAPTURE(shift);
    std::vector<Eigen::Vector3f> cloud = sequence.scans().front().points;
    for (Eigen::Vector3f& point : cloud) point.y() += shift;
    const ProtocolResult result = scorer->score_cloud(CloudEstimate(cloud));
    CHECK(result.warnings.size() == (shift > 0.1f ? 1 : 0));
    CHECK(result.count("estimate_voxels_without_partner") == (shift > 0.2f ? 3 : 0));
    CHECK(result.rate("PR") == (shift > 0.2f ? 0.0 : 100.0));
  }
}

TEST_CASE("scans that change after a protocol was opened are bad data", "[erasor][edge]") {
  MovedSequence sequence({row_of({{40, false}, {40, true}, {252, false}})});
  for (const char* protocol : {"erasor", "dynamicmap"}) {
    sequence.shift = 0.0;
    const auto scorer = protocol_with(protocol)->open(sequence.input());
    CHECK_NOTHROW(scorer->score(sequence.masks()));
    sequence.shift = 0.45;
    CHECK_THAT(message_of<DataError>([&] { (void)scorer->score(sequence.masks()); }),
               Contains("changed"));
  }
}

}  // namespace raymoval::test
