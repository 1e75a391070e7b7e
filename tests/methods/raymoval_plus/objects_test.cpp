// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects/objects.h"

#include <array>
#include <catch2/catch.hpp>

#include "methods/raymoval_plus/objects/point_evidence.h"
#include "methods/raymoval_plus/objects/reasons.h"
#include "tests/methods/raymoval_plus/scene.h"

namespace raymoval::raymoval_plus_test {
using namespace raymoval::raymoval_plus_method;

TEST_CASE("points of a scan that are near each other and above the ground are a cluster") {
  Scene scene;
  scene.add_column(5.05, 0.05, 0.05, 4, Verdict::kStatic, {});   // 0.05 m to 0.65 m high.
  scene.add_column(5.35, 0.05, 0.31, 3, Verdict::kStatic, {});   // 0.3 m aside.
  scene.add_column(5.85, 0.05, 0.31, 3, Verdict::kStatic, {});   // 0.5 m aside: more than 0.36 m.
  scene.add_column(80.05, 0.05, 0.31, 3, Verdict::kStatic, {});  // Beyond the evidence range.
  const SegmentedScan scan = scene.segmented();
  CHECK(scan.high_points == std::vector<std::uint32_t>{2, 3, 4, 5, 6, 7, 8, 9});
  CHECK(scan.cluster_of == std::vector<int>{0, 0, 0, 0, 0, 1, 1, 1});
  CHECK(scan.clusters[0].points == 5);
  scene.parameters.objects = false;
  CHECK(scene.segmented().clusters.empty());
  CHECK(scene.objects().empty());
}

TEST_CASE("a cluster goes with a pass outside a point, or fewer and contradicted voxels") {
  // Of 20 points, each with one pass before and some hits: a contradiction of 1 / (1 + 2 + 1) or
  // 1 / (1 + 5 + 1).
  for (const auto& [passes, hits, goes] :
       {std::tuple{1.0F, 5U, true}, std::tuple{0.95F, 5U, false}, std::tuple{0.25F, 2U, true},
        std::tuple{0.25F, 5U, false}, std::tuple{0.15F, 2U, false}}) {
    Scene scene;
    scene.add_column(5.05, 0.05, 0.41, 20, Verdict::kStatic,
                     {.passes_outside = passes, .first = 1, .last = hits, .passes_before = 1});
    CHECK(scene.dynamic(0, 20) == (goes ? 20 : 0));
    CHECK(scene.dynamic(0, 20, {0}) == 20);  // A track marked it.
    scene.parameters.object_points = 21;
    CHECK(scene.dynamic(0, 20) == 0);
    scene.parameters.objects = false;
    CHECK(scene.dynamic(0, 20, {0}) == 0);
  }
}

TEST_CASE("a cluster stays as a whole if a tenth of it is dynamic, and else keeps its verdicts") {
  for (const int dynamic : {2, 3}) {
    Scene scene;
    scene.add_column(5.05, 0.05, 0.41, dynamic, Verdict::kDynamic, {});
    scene.add_column(5.25, 0.05, 0.41, 20 - dynamic, Verdict::kStatic, {});
    CHECK(scene.dynamic(0, 20) == (dynamic == 2 ? 0 : 3));
  }
}

TEST_CASE("what stands beside something that goes keeps its points, if it is half of the cluster") {
  // 30 points of somebody who came in scan 40, and a pole that stood always, in one cluster. Even
  // if a track marks it.
  using Known = Scene::Known;
  for (const auto& [points, known, stays] :
       {std::tuple{30, Known{.last = 100}, true}, std::tuple{29, Known{.last = 100}, false},
        std::tuple{30, Known{.first = 92, .last = 100}, false},  // Nine hits.
        // More than 0.2 a voxel.
        std::tuple{30, Known{.passes_outside = 0.5F, .last = 100}, false}}) {
    Scene scene;
    for (int k = 0; k < 3; ++k) {
      scene.add_column(5.05, 0.05 + 0.2 * k, 0.41, 10, Verdict::kDynamic,
                       {.passes_outside = 4.0F, .first = 40, .last = 50});
    }
    for (int k = 0; k < points; ++k) {
      scene.add({5.25, 0.05 + 0.2 * (k % 3), 0.41 + 0.2 * (k / 3)}, Verdict::kStatic, known);
    }
    CAPTURE(points, known.passes_outside);
    for (const std::vector<int>& marked : {std::vector<int>{}, {0}}) {
      CHECK(scene.dynamic(0, 30, marked) == 30);
      CHECK(scene.dynamic(30, 30 + points, marked) == (stays ? 0 : points));
    }
  }
}

TEST_CASE("something that moves goes out of a static cluster of a thousand points") {
  // A wall, and ten points before it.
  for (const auto& [columns, passes, verdict, goes] :
       {std::tuple{99, 2.0F, Verdict::kDynamic, true},
        std::tuple{98, 2.0F, Verdict::kDynamic, false},
        std::tuple{99, 1.5F, Verdict::kDynamic, false},
        std::tuple{99, 2.0F, Verdict::kStatic, false}}) {
    Scene scene;
    for (int n = 0; n < columns; ++n) {
      scene.add_column(5.25, 0.2 * n - 9.85, 0.41, 10, Verdict::kStatic, {.last = 100});
    }
    scene.add_column(5.05, 0.15, 0.41, 10, verdict,
                     {.passes_outside = passes, .first = 40, .last = 50});
    REQUIRE(scene.segmented().clusters.size() == 1);
    CHECK(scene.dynamic(0, 10 * columns) == 0);
    CHECK(scene.dynamic(10 * columns, 10 * columns + 10) == (goes ? 10 : 0));
  }
}

TEST_CASE("a fragment goes with what goes beside it") {
  // An object of 6 points at x = 5.05 m, y = 0.05 m, and beside it some points that nothing passed.
  // The reach is 2.5 x (0.3 m + 0.01 x their range), 0.881 m at 5.22 m.
  for (const auto& [apart, points, goes_along] :
       {std::tuple{0.6, 3, true}, std::tuple{0.86, 3, true}, std::tuple{0.9, 3, false},
        std::tuple{0.6, 4, false}}) {  // Four are an object of their own.
    Scene scene;
    scene.add_column(5.05, 0.05, 0.45, 6, Verdict::kStatic, {});
    for (int k = 0; k < points; ++k) {
      scene.add({5.05, 0.05 + apart, 1.0 + 0.05 * k}, Verdict::kStatic);
    }
    CHECK(scene.dynamic(0, 6 + points) == 0);
    CHECK(scene.dynamic(0, 6 + points, {0}) == (goes_along ? 9 : 6));
  }
}

TEST_CASE("a fragment does not go with another, nor with what is too wide to be one thing") {
  Scene pair;
  pair.add_column(5.05, 0.05, 1.0, 3, Verdict::kStatic, {.passes_outside = 4.0F});
  pair.add_column(5.05, 0.65, 1.0, 3, Verdict::kStatic, {});
  CHECK(pair.dynamic(0, 3) == 3);
  CHECK(pair.dynamic(3, 6) == 0);
  for (const int columns : {60, 90}) {  // 11.8 m and 17.8 m long; 15 m are the most.
    Scene wide;
    for (int n = 0; n < columns; ++n) {
      wide.add({5.05, 0.2 * n - 0.1 * columns, 1.0}, Verdict::kDynamic);
    }
    wide.add({5.65, 0.05, 1.0}, Verdict::kStatic);
    CHECK(wide.dynamic(0, columns) == columns);
    CHECK(wide.dynamic(columns, columns + 1) == (columns == 60 ? 1 : 0));
    CHECK(wide.objects().size() == (columns == 60 ? 1 : 0));  // Nor is it tracked.
  }
}

TEST_CASE("what tracks get of a cluster is its box, its mean and the scans that hit it") {
  Scene scene;
  scene.scan.scan.time_s = 3.5;
  scene.add_column(4.05, 3.05, 0.41, 4, Verdict::kDynamic, {.passes_outside = 3.0F});
  scene.add_column(4.25, 3.05, 0.41, 2, Verdict::kStatic, {.first = 70'000, .last = 70'007});
  scene.add_column(4.25, 3.05, 0.81, 2, Verdict::kStatic,
                   {.passes_outside = 1.0F, .first = 70'004, .last = 70'009});
  scene.add_column(9.05, 3.05, 0.41, 3, Verdict::kDynamic, {});  // Too few points.
  const auto objects = scene.objects();
  REQUIRE(objects.size() == 1);
  CHECK(objects[0].cluster == 0);
  CHECK(objects[0].points == 8);
  CHECK(objects[0].evidence.dynamic == 4);
  CHECK(objects[0].evidence.passes == 14.0F);
  CHECK(objects[0].time_s == 3.5);
  // Of the points that are not dynamic.
  CHECK(objects[0].hits == 7.0F);
  CHECK(objects[0].first_hit == 70'002.0);
  CHECK(objects[0].last_hit == 70'008.0);
  CHECK(objects[0].center.isApprox(Eigen::Vector3d(4.15, 3.05, 0.71), 1e-6));
  CHECK(objects[0].low.isApprox(Eigen::Vector3d(4.05, 3.05, 0.41), 1e-6));
  CHECK(objects[0].high.isApprox(Eigen::Vector3d(4.25, 3.05, 1.01), 1e-6));
  CHECK(objects[0].width() == Approx(0.2).epsilon(1e-5));
  CHECK(objects[0].range == Approx(objects[0].center.norm()));
  scene.parameters.tracks = false;
  CHECK(scene.objects().empty());
}

TEST_CASE("the reason for a verdict is the step that made it") {
  // Eight voxels, and three of the ground: whether it was observed as free, then the result of the
  // vote, of the objects, and of the low points.
  const std::vector<std::array<std::uint8_t, 5>> stories{
      {0, 0, 0, 0, 0}, {1, 1, 1, 1, 2}, {0, 1, 1, 1, 3}, {1, 0, 0, 0, 4},
      {1, 0, 1, 1, 5}, {1, 1, 0, 0, 6}, {0, 0, 0, 1, 7}, {1, 1, 1, 0, 8},
      {0, 0, 0, 0, 1}, {1, 0, 0, 0, 1}, {1, 1, 1, 1, 2}};
  const auto verdict = [](int dynamic) {
    return dynamic == 1 ? Verdict::kDynamic : Verdict::kStatic;
  };
  EvidenceMaps maps{Parameters{}};
  SegmentedScan scan;
  Verdicts by_objects, decided;
  EvidenceMap::Blocks::Cursor cursor, ground_cursor;
  for (std::size_t k = 0; k < stories.size(); ++k) {
    const bool is_ground = k >= 8;
    const VoxelIndex cell(static_cast<int>(k), 0, 0);
    EvidenceMap& map = is_ground ? maps.ground : maps.standing;
    const auto voxel = map.add(cell, 0, is_ground ? ground_cursor : cursor);
    map.set_decision(voxel, verdict(stories[k][0]));
    scan.voxel.push_back(is_ground ? EvidenceMap::kNone : voxel);
    scan.ground_voxel.push_back(is_ground ? voxel : EvidenceMap::kNone);
    scan.verdict.push_back(verdict(stories[k][1]));
    by_objects.push_back(verdict(stories[k][2]));
    decided.push_back(verdict(stories[k][3]));
  }
  const auto reasons = reasons_for(scan, maps, by_objects, decided);
  for (std::size_t k = 0; k < stories.size(); ++k) CHECK(reasons[k] == stories[k][4]);
  CHECK(reason_sentences().at(1) == "it is ground, or was when its scan came");
  CHECK(reason_sentences().at(8) == "what stands above it stays");
}

TEST_CASE("the verdict counts half, the voxel and the object a quarter each") {
  EvidenceMaps maps{Parameters{}};
  EvidenceMap::Blocks::Cursor cursor, ground_cursor;
  const std::uint32_t passed = maps.standing.add({0, 0, 2}, 0, cursor);
  const std::uint32_t untouched = maps.standing.add({9, 9, 2}, 0, cursor);
  const std::uint32_t false_ground = maps.ground.add({5, 5, 0}, 0, ground_cursor);
  maps.standing.evidence(passed) = evidence_of("ppp");       // 3 of 3 + 1.
  maps.ground.evidence(false_ground) = evidence_of("pppp");  // 4 of 4 + 1.
  SegmentedScan scan;
  constexpr std::uint32_t kNone = EvidenceMap::kNone;
  scan.scan.points.resize(6);
  scan.voxel = {passed, untouched, untouched, kNone, kNone, kNone};
  scan.ground_voxel = {kNone, kNone, kNone, kNone, false_ground, false_ground};
  // Points 0 and 1 are one object of which one point is dynamic; other points are no object.
  scan.high_points = {0, 1};
  scan.cluster_of = {0, 0};
  scan.clusters = {{2, {.dynamic = 1}}};
  const Verdicts decided = {Verdict::kDynamic, Verdict::kStatic,  Verdict::kDynamic,
                            Verdict::kStatic,  Verdict::kDynamic, Verdict::kStatic};
  scan.verdict = decided;
  const std::vector<float> evidence = evidence_of_points(scan, decided, maps);
  CHECK(evidence[0] == Approx(0.5 + 0.25 * 0.75 + 0.25 * 0.5));
  CHECK(evidence[1] == Approx(0.25 * 0.5));
  CHECK(evidence[2] == Approx(0.5));  // Only the decision supports it.
  CHECK(evidence[3] == 0.0F);         // Ground without a voxel.
  CHECK(evidence[4] == Approx(0.5 + 0.5 * 0.8));
  CHECK(evidence[5] == 0.0F);  // Ground that is kept.
}

}  // namespace raymoval::raymoval_plus_test
