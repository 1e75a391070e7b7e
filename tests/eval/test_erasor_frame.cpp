// SPDX-License-Identifier: MIT
// ERASOR's own world frame: A P Tr_fixed L, with the camera pose P of the data set.
#include <catch2/catch.hpp>

#include "core/error.h"
#include "eval/erasor/maps/accumulate.h"
#include "eval/points/cloud_masks.h"
#include "tests/eval/memory_sequence.h"

namespace raymoval::test {
namespace {

using Catch::Contains;

Pose some_pose() {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d(0.1, -0.2, 1.0).normalized()).matrix();
  pose.translation() << 120.0, -35.0, 2.0;
  return pose;
}

/// Tr of SemanticKITTI 00, 01 and 02.
Pose calibration_of_00() {
  Pose pose = Pose::Identity();
  pose.linear() << 4.276802385584e-04, -9.999672484946e-01, -8.084491683471e-03,  //
      -7.210626507497e-03, 8.081198471645e-03, -9.999413164504e-01,               //
      9.999738645903e-01, 4.859485810390e-04, -7.206933692422e-03;
  pose.translation() << -1.198459927713e-02, -5.403984729748e-02, -2.921968648686e-01;
  return pose;
}

/// Four voxels: a static and a moving point that are kept, and one of each that is flagged.
MemorySequence four_points() {
  LabelledScan scan;
  scan.pose = some_pose();
  scan.add(10.0f, 0.0f, 0.0f, 40);
  scan.add(12.0f, 0.0f, 0.0f, 40, true);
  scan.add(14.0f, 0.0f, 0.0f, 252);
  scan.add(16.0f, 0.0f, 0.0f, 252, true);
  return MemorySequence({scan});
}

}  // namespace

TEST_CASE("with the fixed calibration all scans move alike", "[erasor][frame]") {
  // Tr = Tr_fixed: A Tr T Tr^-1 Tr = (A Tr) T, where (A Tr) is the pose of the identity.
  const Pose& Tr = erasor::fixed_calibration();
  const Pose constant = erasor::erasor_pose(Pose::Identity(), Tr);
  const Pose placed = erasor::erasor_pose(some_pose(), Tr);
  CHECK(placed.isApprox(constant * some_pose(), 1e-6));
  // Less than a degree from the sequence's own axes, as A undoes the turn into the camera's.
  CHECK(Eigen::AngleAxisd(constant.rotation()).angle() < 0.0175);
}

TEST_CASE("another calibration displaces scans against each other by as much as is known",
          "[erasor][frame]") {
  // A scan at the identity is put at A Tr_fixed and not at A Tr_00, where the sequence's own
  // calibration has it. Tr_00^-1 Tr_fixed is 0.137 degrees, 2.29 mrad of them yaw, and
  // (-0.042, -0.007, 0.020) m.
  const Pose placed = erasor::erasor_pose(Pose::Identity(), calibration_of_00());
  const Pose axes = placed * erasor::fixed_calibration().inverse();
  const Pose displaced = (axes * calibration_of_00()).inverse() * placed;
  CHECK(displaced.translation().isApprox(Eigen::Vector3d(-0.0417, -0.0074, 0.0196), 2e-3));
  CHECK(displaced.linear()(1, 0) == Approx(2.29e-3).epsilon(1e-2));
  CHECK(Eigen::AngleAxisd(displaced.rotation()).angle() ==
        Approx(0.137 * M_PI / 180).epsilon(1e-2));
}

TEST_CASE("points are lifted along the sensor's axis before they are placed", "[erasor][frame]") {
  const MemorySequence sequence = four_points();
  EvaluationInput input = sequence.input();
  input.T_camera_lidar = calibration_of_00();
  erasor::Options options;
  options.frame = erasor::FrameOption::kErasor;
  const LabelClasses classes(input.label_rule);
  const LabelledCloud dense = erasor::dense_map({input, options, classes}, "");
  const Pose pose = erasor::erasor_pose(some_pose(), calibration_of_00());
  REQUIRE(dense.size() == 4);
  for (const float x : {10.0f, 12.0f, 14.0f, 16.0f}) {
    const Eigen::Vector3d expected = pose * Eigen::Vector3d(x, 0.0, 1.73);
    CHECK(std::any_of(dense.points.begin(), dense.points.end(), [&](const Eigen::Vector3d& point) {
      return (point - expected).norm() < 1e-9;
    }));
  }
}

TEST_CASE("both sides stand in the frame", "[erasor][frame]") {
  const MemorySequence sequence = four_points();
  EvaluationInput input = sequence.input();
  input.T_camera_lidar = calibration_of_00();
  const ProtocolResult result =
      score_erasor(input, sequence.masks(), {{"frame", std::string("erasor")}});
  // Points lie 2 m apart: no flagged one has a partner.
  CHECK(result.rate("PR") == Approx(50.0));
  CHECK(result.rate("RR") == Approx(50.0));
  CHECK(result.count("estimate_voxels_without_partner") == 0);
}

TEST_CASE("the frame needs a calibration and no cloud", "[erasor][frame]") {
  const MemorySequence sequence = four_points();
  const Settings settings = {{"frame", std::string("erasor")},
                             {"label_mode", std::string("nearest")}};
  const auto protocol = erasor_protocol(settings);
  EvaluationInput input = sequence.input();
  CHECK_THROWS_WITH(protocol->open(input), Contains("calib.txt") && Contains("frame"));
  CHECK_THROWS_AS(protocol->open(input), DataError);
  input.T_camera_lidar = calibration_of_00();
  const auto scorer = protocol->open(input);
  const std::vector<Eigen::Vector3f> no_points;
  const CloudEstimate cloud(no_points);
  CHECK_THROWS_WITH(scorer->score_cloud(cloud), Contains("frame = sequence"));
  CHECK(protocol->reads_calibration());
  CHECK_FALSE(erasor_protocol()->reads_calibration());
}

}  // namespace raymoval::test
