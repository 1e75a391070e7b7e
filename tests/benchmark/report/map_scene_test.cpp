// SPDX-License-Identifier: MIT
#include "benchmark/report/scene.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "benchmark/report/page.h"

using namespace raymoval;
using Catch::Matchers::Contains;

namespace {

/// Two scans of a line of points a metre apart, of which every tenth is removed. The confidence of
/// removed points is 200 steps, of every hundredth other one 10 steps, else 1 step.
Scene line_scene(std::size_t limit, double gap = 1.0) {
  MapSceneBuilder builder("line", "method", Pose::Identity(), limit);
  Scan scan;
  scan.T_world_sensor.translation().z() = 1.0;
  Mask mask;
  std::string confidence;
  for (int i = 0; i < 1000; ++i) {
    scan.points.emplace_back(static_cast<float>(gap * i), 0.0F, -1.0F);
    mask.push_back(i % 10 == 0 ? 1 : 0);
    confidence += static_cast<char>(i % 10 == 0 ? 200 : i % 100 == 1 ? 10 : 1);
  }
  for (const char* name : {"first", "second"}) {
    scan.name = name;
    builder.add(scan, mask, confidence);
    ++scan.index;
  }
  return builder.finish();
}

std::size_t removed_in(const Scene& scene) {
  std::size_t removed = 0;
  for (const std::uint8_t verdict : scene.verdicts.at(0)) removed += verdict & 1U;
  return removed;
}

}  // namespace

TEST_CASE("A map's scene shows what was kept once, and what was removed in each scan") {
  const Scene scene = line_scene(100000);
  CHECK(scene.is_unlabelled);
  CHECK(scene.points.size() == 900 + 2 * 100);
  CHECK(removed_in(scene) == 200);
  CHECK(scene.counts[0].kept_static == 1800);
  CHECK(scene.counts[0].true_positive == 200);
  CHECK(scene.points_in_range == 2000);
  CHECK(scene.trajectory.size() == 2);
}

TEST_CASE("A map's scene is thinned to its limit") {
  const Scene scene = line_scene(200);
  CHECK(scene.points.size() <= 200);
  CHECK(removed_in(scene) <= 80);
  CHECK(removed_in(scene) > 0);
  CHECK(scene.other_cell > kStepsPerVoxel);
}

TEST_CASE("A map's scene counts the points of each confidence") {
  const Scene scene = line_scene(100000);
  CHECK(scene.confidences.at(200) == 200);
  CHECK(scene.confidences.at(10) == 20);
  CHECK(scene.confidences.at(1) == 1780);
  CHECK(std::accumulate(scene.confidences.begin(), scene.confidences.end(), std::uint64_t{0}) ==
        2000);
}

TEST_CASE("Kept points that may move are shown beside others of their cell") {
  // A point every 0.01 m: 20 in a cell of 0.2 m, over 50 cells. Every tenth cell has one such
  // point.
  const Scene scene = line_scene(100000, 0.01);
  std::size_t kept = 0, uncertain = 0;
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    if (scene.verdicts[0][i] != 0) continue;
    ++kept;
    if (scene.verdicts[1][i] == 10) ++uncertain;
  }
  CHECK(uncertain == 10);
  CHECK(kept == 60);
}

TEST_CASE("A map's scene holds the answer that is reviewed") {
  const Scene scene = line_scene(100000);
  REQUIRE(scene.review.scans.size() == 2);
  CHECK(scene.review.scans[1].points == 1000);
  CHECK(scene.review.scans[1].runs.size() == 200);
  CHECK(scene.review.removed_cell == kStepsPerVoxel);
  CHECK(scene.review.kept_cell == kStepsPerVoxel);
}

TEST_CASE("Cells of a wide map are whole units of its coordinates") {
  // 0 m to 9,990 m: 799,200 steps need 20 bits, so 16 steps are a unit of 16 bits. The cells grow
  // from 16 steps by a quarter, to 20 steps and more.
  const Scene scene = line_scene(500, 10.0);
  const PageFrame frame = page_frame(scene.points, scene.shift);
  const int unit = 1 << frame.shift;
  CHECK(unit == 16);
  CHECK(scene.review.kept_cell > kStepsPerVoxel);
  CHECK(scene.review.kept_cell % unit == 0);
  CHECK(scene.review.removed_cell % unit == 0);
  for (const ShownPoint& point : scene.points) {
    const int shown = (point.step[0] - frame.origin[0] * kStepsPerVoxel) / unit * unit;
    CHECK(map_cell({shown + frame.origin[0] * kStepsPerVoxel, 0, 0}, scene.review.kept_cell)[0] ==
          map_cell(point.step, scene.review.kept_cell)[0]);
  }
}

TEST_CASE("A map's page says that nothing is labelled") {
  const std::string page = map_page(line_scene(1000), "line <1>", {"Two scans."});
  CHECK_THAT(page, Contains("\"unlabelled\":true") && Contains("line &lt;1&gt;") &&
                       Contains("Two scans."));
}
