// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects/low_points.h"

#include <array>
#include <catch2/catch.hpp>
#include <map>
#include <random>

#include "tests/methods/raymoval_plus/scene.h"

namespace raymoval::raymoval_plus_test {
using namespace raymoval::raymoval_plus_method;

TEST_CASE("low points follow what stands above them, if two thirds of that agree") {
  // Feet at 0.1 m and 0.2 m, and a leg of ten points from 0.3 m on, of which some are dynamic.
  // With half of it dynamic, the feet are as they were.
  for (const auto& [dynamic, feet] : {std::pair{3, 0}, std::pair{5, 2}, std::pair{7, 3}}) {
    Scene scene;
    for (const double z : {0.1, 0.25}) scene.add({5.05, 0.05, z}, Verdict::kDynamic);
    scene.add({5.05, 0.05, 0.15}, Verdict::kStatic);
    for (int k = 0; k < 10; ++k) {  // In the column beside.
      scene.add({5.05, 0.25, 0.3 + 0.06 * k}, k < dynamic ? Verdict::kDynamic : Verdict::kStatic);
    }
    // Points higher than 1 m and 0.03 of their range, 0.16 m, are not above these points.
    for (int k = 0; k < 100; ++k) scene.add({5.05, 0.05, 1.17 + 0.01 * k}, Verdict::kDynamic);
    const Verdicts decided = scene.with_low_points();
    CHECK(std::count(decided.begin(), decided.begin() + 3, Verdict::kDynamic) == feet);
    CHECK(std::equal(decided.begin() + 3, decided.end(), scene.scan.verdict.begin() + 3));
    scene.parameters.low_points = false;
    CHECK(scene.with_low_points() == scene.scan.verdict);
  }
}

TEST_CASE("what is taken for ground follows what moves above it, if the ground is lower there") {
  // A foot whose points are taken for ground, and a leg above it. By a hundred points of earlier
  // scans the ground is at `base`, by the terrain at 0: a road, or a pavement beside it.
  for (const double base : {0.001, 0.051}) {
    for (const Verdict leg : {Verdict::kDynamic, Verdict::kStatic}) {
      for (const Verdict foot : {Verdict::kDynamic, Verdict::kStatic}) {
        Scene scene;
        for (int n = 0; n < 100; ++n) scene.see_ground({5.05, 0.05, base});
        for (const double z : {-0.02, 0.0, 0.006, 0.02}) {
          scene.add_ground({5.05, 0.05, base + z}, foot);
        }
        for (int k = 0; k < 6; ++k) scene.add({5.05, 0.25, 0.35 + 0.1 * k}, leg);  // Beside it.
        Verdicts expected = scene.scan.verdict;
        // The mean is unchanged, within 1 mm. Points in voxels that beams passed stay dynamic, with
        // any points above them.
        if (leg == Verdict::kDynamic) expected[3] = Verdict::kDynamic;
        CHECK(scene.with_low_points() == expected);
      }
    }
  }
  Scene changed;  // A point that was no ground when its scan was added.
  changed.add({5.05, 0.05, 0.01}, Verdict::kStatic);
  changed.scan.voxel.back() = EvidenceMap::kNone;
  changed.add({5.05, 0.05, 0.45}, Verdict::kDynamic);
  CHECK(changed.with_low_points()[0] == Verdict::kDynamic);
}

namespace {

/// Step 8 with every column counted. 1 for each point that is dynamic afterwards.
std::vector<int> slow_low_points(const Scene& scene, const Verdicts& before) {
  const LocatedScan& scan = scene.scan;
  const float steps = scene.maps.elevation_step;
  std::map<std::pair<int, int>, std::array<int, 2>> standing;  // Fixed and dynamic points.
  for (std::size_t k = 0; k < before.size(); ++k) {
    const float range = scan.scan.points[k].norm();
    if (scan.height[k] < 0.3F || scan.height[k] >= 1.0F + 0.03F * range) continue;
    ++standing[{scan.in_map.x[k], scan.in_map.y[k]}][before[k] == Verdict::kDynamic ? 1 : 0];
  }
  std::vector<int> dynamic(before.size());
  for (std::size_t k = 0; k < before.size(); ++k) {
    dynamic[k] = before[k] == Verdict::kDynamic ? 1 : 0;
    const bool is_ground = scan.voxel[k] == EvidenceMap::kNone;
    if (!is_ground && scan.height[k] >= 0.3F) continue;
    const double mean = is_ground ? scene.maps.ground.centroid(scan.ground_voxel[k]).z() : 0.0;
    // A point is counted at the middle of a part of its cell, of which there are 256.
    if (is_ground && std::floor(scan.height[k] * 640.0) / 640.0 + 0.5 / 640.0 - mean < 0.01)
      continue;
    const int reach = 1 + static_cast<int>(scan.scan.points[k].norm() * 0.6F * steps / 0.2F);
    std::array<int, 2> sum{};
    for (const auto& [at, points] : standing) {
      if (std::abs(at.first - scan.in_map.x[k]) > reach) continue;
      if (std::abs(at.second - scan.in_map.y[k]) > reach) continue;
      for (std::size_t i = 0; i < 2; ++i) sum[i] += points[i];
    }
    if (sum[1] > 0 && sum[1] >= 2 * sum[0]) {
      dynamic[k] = 1;
    } else if (!is_ground && sum[0] > 0 && sum[0] >= 2 * sum[1]) {
      dynamic[k] = 0;
    }
  }
  return dynamic;
}

}  // namespace

TEST_CASE("low points are those of a count over all columns") {
  std::mt19937 random(21);
  std::uniform_real_distribution<double> place(-1.5, 1.5), height(0.07, 2.3), low(0.0, 0.07);
  int changed = 0, changed_ground = 0;
  for (int round = 0; round < 24; ++round) {
    const double away = 10.0 * (round % 3);
    Scene scene;
    scene.maps.elevation_step = 0.035F;
    Verdicts before;
    for (int i = 0; i < 1200; ++i) {
      const bool is_ground = random() % 3 == 0;
      const double z = is_ground ? low(random) : height(random);
      const Eigen::Vector3d at(away + place(random), place(random), z);
      // Dynamic ones gather on one side, of the ground fewer.
      const bool dynamic =
          at.x() - away > 1.0 ? random() % 4 > (is_ground ? 2U : 0U) : random() % 20 == 0;
      before.push_back(dynamic             ? Verdict::kDynamic
                       : random() % 5 == 0 ? Verdict::kUndecided
                                           : Verdict::kStatic);
      is_ground ? scene.add_ground(at, before.back()) : scene.add(at, before.back());
    }
    const Verdicts decided = scene.with_low_points();
    const std::vector<int> expected = slow_low_points(scene, before);
    for (std::size_t k = 0; k < decided.size(); ++k) {
      CAPTURE(k, scene.scan.height[k], scene.scan.voxel[k]);
      REQUIRE((decided[k] == Verdict::kDynamic) == (expected[k] == 1));
      if ((before[k] == Verdict::kDynamic) == (expected[k] == 1)) continue;
      ++changed;
      if (scene.scan.voxel[k] == EvidenceMap::kNone) ++changed_ground;
    }
  }
  CHECK(changed > 50);
  CHECK(changed_ground > 20);
}

}  // namespace raymoval::raymoval_plus_test
