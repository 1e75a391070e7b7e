// SPDX-License-Identifier: MIT
// What counts where: small scenes for counts, frames and warnings of all protocols.
#include <catch2/catch.hpp>
#include <cstdio>
#include <set>

#include "core/error.h"
#include "eval/columns/removal_tally.h"
#include "eval/erasor/maps/accumulate.h"
#include "eval/points/cloud_masks.h"
#include "tests/eval/memory_sequence.h"

namespace raymoval::test {
namespace {

/// Points a metre apart from x = 5 on, each in voxels and cells of its own.
LabelledScan row_with(const std::vector<std::pair<std::uint32_t, bool>>& points) {
  LabelledScan scan;
  float x = 5.05f;
  for (const auto& [label, flagged] : points) {
    scan.add(x, 0.05f, 0.05f, label, flagged);
    x += 1.0f;
  }
  return scan;
}

ProtocolResult score_scans(const std::string& protocol, const std::vector<LabelledScan>& scans,
                           const Settings& settings = {}) {
  const MemorySequence sequence(scans);
  return score_by(protocol, sequence.input(), sequence.masks(), settings);
}

std::set<std::string> truth_counts(const std::string& protocol) {
  std::set<std::string> names;
  for (const CountSpec& spec : protocol_entry(protocol).counts) {
    if (spec.of_truth) names.insert(spec.name);
  }
  return names;
}

}  // namespace

TEST_CASE("the counts that no mask can change are those of scans and labels", "[counts]") {
  CHECK(truth_counts("erasor") ==
        std::set<std::string>{"static_voxels", "dynamic_voxels", "static_voxels_no_truck",
                              "dynamic_voxels_no_truck", "mixed_label_ties", "unlabelled_voxels",
                              "evaluated_points", "out_of_range_points", "ignored_points",
                              "cropped_points"});
  CHECK(truth_counts("dynamicmap") == std::set<std::string>{"static_points", "dynamic_points",
                                                            "ego_points", "out_of_range_points",
                                                            "ignored_points"});
  CHECK(truth_counts("dynamicmap-strict") ==
        std::set<std::string>{"static_voxels", "dynamic_voxels", "mixed_voxels", "ego_points",
                              "out_of_range_points", "ignored_points"});
  CHECK(rate_spec("F1").formula->shown_of_means);
  CHECK_FALSE(rate_spec("HA").formula->shown_of_means);
  CHECK(protocol_entry("erasor").cloud_options ==
        Configuration{{"label_mode", std::string("nearest")}, {"lift", 0.0}});
}

TEST_CASE("counts are summed over scans, and dropped points are on neither side", "[counts]") {
  LabelledScan scan = row_with({{40, false}, {258, true}, {99, false}});
  scan.add(1.0f, 0.0f, 0.0f, 0);    // Unlabelled near the sensor: the ego vehicle.
  scan.add(60.0f, 0.0f, 0.0f, 40);  // Out of range: neither kept nor flagged.
  scan.add(61.0f, 0.0f, 0.0f, 252, true);
  const MemorySequence sequence({scan, scan, row_with({{40, false}})});
  EvaluationInput input = sequence.input();
  input.range_m = {0.0, 50.0};
  input.label_rule.ignored = {99};
  const ProtocolResult points = score_by("dynamicmap", input, sequence.masks());
  CHECK(points.count("ego_points") == 2);
  CHECK(points.count("out_of_range_points") == 4);
  CHECK(points.count("ignored_points") == 2);
  CHECK(points.count("static_points") == 3);
  CHECK(points.count("dynamic_points") == 4);
  CHECK(points.count("kept_static_points") == 3);
  CHECK(points.count("flagged_dynamic_points") == 2);
  const ProtocolResult voxels = score_by("erasor", input, sequence.masks());
  CHECK(voxels.count("cropped_points") == 2);
  CHECK(voxels.count("out_of_range_points") == 4);
  CHECK(voxels.count("ignored_points") == 2);
  CHECK(voxels.count("evaluated_points") == 5);
  CHECK(voxels.count("removed_points") == 2);
  CHECK(voxels.rate("PR") == 100.0);
  CHECK(voxels.rate("RR") == 100.0);
  const ProtocolResult strict = score_by("dynamicmap-strict", input, sequence.masks());
  CHECK(strict.count("ego_points") == 2);
  CHECK(strict.count("out_of_range_points") == 4);
  CHECK(strict.count("ignored_points") == 2);
  // A last scan without a point left is no error.
  const MemorySequence far_end({row_with({{40, false}}), LabelledScan{}});
  CHECK(score_by("dynamicmap", far_end.input(), far_end.masks()).count("static_points") == 1);
}

TEST_CASE("a kept point a metre and a half away is near within two metres", "[counts]") {
  LabelledScan scan;
  scan.add(5.0f, 0.0f, 0.0f, 40, true);
  scan.add(6.5f, 0.0f, 0.0f, 252);
  for (const auto& [distance, present] : {std::pair{2.0, 1}, std::pair{1.5, 1}, {1.4, 0}}) {
    const ProtocolResult result = score_scans("dynamicmap", {scan}, {{"distance", distance}});
    CHECK(result.count("present_static_points") == present);
    CHECK(result.count("kept_static_points") == 0);
  }
}

TEST_CASE("a kept point beyond any wall of the cells that are searched is found", "[counts]") {
  // Within 2 m cells of 4 m are searched. The removed point lies 0.1 m within the cell around
  // (22, 2, 2), the kept one as far beyond it: over each side, edge and corner.
  for (int i = 0; i < 27; ++i) {
    const Eigen::Vector3f way(static_cast<float>(i % 3 - 1), static_cast<float>(i / 3 % 3 - 1),
                              static_cast<float>(i / 9 - 1));
    if (way.isZero()) continue;
    const Eigen::Vector3f centre(22.0f, 2.0f, 2.0f);
    const Eigen::Vector3f removed = centre + 1.9f * way, kept = centre + 2.1f * way;
    CAPTURE(way.transpose());
    for (const bool ignored_in_estimate : {true, false}) {
      LabelledScan scan;
      scan.add(removed.x(), removed.y(), removed.z(), 40, true);
      scan.add(kept.x(), kept.y(), kept.z(), 252);
      const ProtocolResult result = score_scans(
          "dynamicmap", {scan}, {{"distance", 2.0}, {"ignored_in_estimate", ignored_in_estimate}});
      CHECK(result.count("present_static_points") == 1);
    }
  }
}

TEST_CASE("ties within a scan and between scans are counted on both sides", "[counts]") {
  // Cells of 0.25 m. In the cell at x = 5 a static and a moving point of one scan lie 1/16 m to
  // either side of their mean, in that at x = 7 one of each scan.
  LabelledScan first, second;
  first.add(5.0625f, 0.125f, 0.125f, 40);
  first.add(5.1875f, 0.125f, 0.125f, 252);
  first.add(7.0625f, 0.125f, 0.125f, 40);
  second.add(7.1875f, 0.125f, 0.125f, 252);
  const ProtocolResult result =
      score_scans("erasor", {first, second}, {{"voxel_size", 0.25}, {"lift", 0.0}});
  CHECK(result.count("mixed_label_ties") == 2);
  CHECK(result.count("estimate_mixed_label_ties") == 2);
  // The first point of the first scan gives its label.
  CHECK(result.count("static_voxels") == 2);
  CHECK(result.count("dynamic_voxels") == 0);
}

TEST_CASE("a warning needs more than half of the estimate beside the truth", "[counts][cloud]") {
  const MemorySequence sequence(
      {row_with({{40, false}, {40, false}, {40, false}, {40, false}, {252, false}})});
  const Settings nearest = {{"label_mode", std::string("nearest")}, {"lift", 0.0}};
  const auto scorer = protocol_with("erasor", nearest)->open(sequence.input());
  const auto warnings = [&](int near, int far) {
    std::vector<Eigen::Vector3f> cloud;
    for (int i = 0; i < near; ++i) cloud.emplace_back(5.05f + static_cast<float>(i), 0.05f, 0.05f);
    for (int i = 0; i < far; ++i) cloud.emplace_back(5.05f + static_cast<float>(i), 3.05f, 0.05f);
    return scorer->score_cloud(CloudEstimate(cloud)).warnings.size();
  };
  CHECK(warnings(4, 1) == 0);
  CHECK(warnings(2, 2) == 0);
  CHECK(warnings(2, 3) == 1);
}

TEST_CASE("a point of a scan is in a cloud up to 5 cm away", "[counts][cloud]") {
  const MemorySequence sequence({row_with({{40, false}, {40, false}, {252, false}})});
  const auto scorer = protocol_with("dynamicmap-strict")->open(sequence.input());
  const std::vector<Eigen::Vector3f> cloud = {{5.05f, 0.09f, 0.05f}, {6.05f, 0.11f, 0.05f}};
  const CloudEstimate estimate(cloud);
  CHECK(scorer->score_cloud(estimate).count("preserved_static") == 1);
  // Asked for with another distance, the masks are others.
  CHECK(estimate.masks(sequence.input(), 0.05).get(0) == Mask{0, 1, 1});
  CHECK(estimate.masks(sequence.input(), 0.07).get(0) == Mask{0, 0, 1});
}

TEST_CASE("the frame of ERASOR's map tool has the axes forward, left and up", "[counts][frame]") {
  // A sensor at the origin: the rows of the fixed calibration (right, down, forward) in the order
  // forward, -right, -down.
  const Pose pose = erasor::erasor_pose(Pose::Identity(), Pose::Identity());
  Eigen::Matrix3d rotation;
  rotation << 9.999773098287e-01, -1.805528627661e-03, -6.496203536139e-03,  //
      1.857739385241e-03, 9.999659513510e-01, 8.039975204516e-03,            //
      6.481465826011e-03, -8.051860151134e-03, 9.999466081774e-01;
  CHECK((pose.linear() - rotation).cwiseAbs().maxCoeff() < 1e-15);
  const Eigen::Vector3d place(-3.339968064433e-01, 4.784029760483e-03, 7.337429464231e-02);
  CHECK((pose.translation() - place).norm() < 1e-15);
  // A metre forward in the camera's frame is a metre along x.
  Pose ahead = Pose::Identity();
  ahead.translation().z() = 1.0;
  const Pose moved = erasor::erasor_pose(ahead, Pose::Identity());
  CHECK((moved.translation() - place - Eigen::Vector3d::UnitX()).norm() < 1e-15);
}

}  // namespace raymoval::test
