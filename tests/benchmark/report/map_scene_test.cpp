// SPDX-License-Identifier: MIT
#include "benchmark/report/scene.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "benchmark/report/page.h"

using namespace raymoval;
using Catch::Matchers::Contains;

namespace {

/// Two scans of a line of points a metre apart, of which every tenth is removed.
Scene line_scene(std::size_t limit) {
  MapSceneBuilder builder("line", "method", Pose::Identity(), limit);
  for (const char* scan : {"first", "second"}) {
    builder.add_scan(scan, Eigen::Vector3d(0.0, 0.0, 1.0));
    for (int i = 0; i < 1000; ++i) builder.add_point({1.0 * i, 0.0, 0.0}, i % 10 == 0);
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

TEST_CASE("A map's page says that nothing is labelled") {
  const std::string page = map_page(line_scene(1000), "line <1>", {"Two scans."});
  CHECK_THAT(page, Contains("\"unlabelled\":true") && Contains("line &lt;1&gt;") &&
                       Contains("Two scans."));
}
