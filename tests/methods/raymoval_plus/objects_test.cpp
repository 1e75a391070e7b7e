// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects/objects.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <functional>
#include <map>
#include <random>

#include "core/parameter_condition.h"
#include "methods/raymoval_plus/objects/low_points.h"
#include "methods/raymoval_plus/objects/point_runs.h"
#include "methods/raymoval_plus/objects/reasons.h"
#include "tests/methods/raymoval_plus/map_points.h"

namespace raymoval::raymoval_plus_test {
using namespace raymoval::raymoval_plus_method;

namespace {

/// A scan from the origin with given verdicts on the voxels of its points. The ground is at height
/// 0.
class Scene {
 public:
  Parameters parameters;
  MapPoints in_map;
  EvidenceMap& map = in_map.map;
  EvidenceMaps maps{Parameters{}};  ///< Only of the ground.
  LocatedScan scan;

  void add(const Eigen::Vector3d& point, Verdict verdict, int agree_scans = 3) {
    const std::uint32_t voxel = in_map.add(point);
    map.evidence(voxel).agree_scans = static_cast<std::uint16_t>(agree_scans);
    map.evidence(voxel).last_agree = 100;  // All came and left at the same time.
    map.set_decision(voxel, verdict);
    EvidenceMap::Blocks::Cursor cursor;
    map.set_verdict_in(map.find_slot(map.index(voxel), cursor), verdict);
    scan.in_map.x.push_back(map.index(voxel).x());
    scan.in_map.y.push_back(map.index(voxel).y());
    scan.in_map.z.push_back(map.index(voxel).z());
    scan.in_map.parts.push_back(MapPoint(point).parts);
    scan.scan.points.push_back(point.cast<float>());
    scan.height.push_back(static_cast<float>(point.z()));
    scan.voxel.push_back(voxel);
    scan.ground_voxel.push_back(EvidenceMap::kNone);
    scan.verdict.push_back(verdict);
  }
  /// Adds what some scan saw of the ground to its map. @return the number of its voxel
  std::uint32_t see_ground(const Eigen::Vector3d& point) {
    const MapPoint at(point);
    EvidenceMap::Blocks::Cursor cursor;
    return maps.ground.add(ground_cell(at.cell), ground_parts(at.cell, at.parts), cursor);
  }
  /// Adds a point that was taken for ground.
  void add_ground(const Eigen::Vector3d& point, Verdict verdict) {
    add(point, verdict);
    scan.voxel.back() = EvidenceMap::kNone;
    scan.ground_voxel.back() = see_ground(point);
  }
  /// Points in a column above (x, y), 0.1 m from each other, from `low` metres upward.
  void add_column(double x, double y, double low, int points, Verdict verdict) {
    for (int k = 0; k < points; ++k) add({x, y, low + 0.1 * k}, verdict);
  }
  [[nodiscard]] SegmentedScan segmented() const {
    SegmentedScan segmented{scan, {}, {}, {}};
    find_clusters(parameters, RunContext{}, segmented);
    divide_clusters(map, parameters, RunContext{}, segmented);
    return segmented;
  }
  [[nodiscard]] std::vector<ObjectSummary> objects(const DirectionSteps& steps = {}) const {
    return summarise_objects(segmented(), map, steps, parameters, RunContext{});
  }
  /// The verdicts after step 8.
  [[nodiscard]] Verdicts with_low_points() const {
    Verdicts verdicts = scan.verdict;
    decide_low_points(scan, maps, parameters, RunContext{}, verdicts);
    return verdicts;
  }
  /// The number of dynamic points from number `first` to before `end`, after step 6.
  [[nodiscard]] int dynamic(int first, int end, const std::vector<int>& marked = {}) const {
    const Verdicts verdicts = decide_objects(segmented(), map, marked, parameters, RunContext{});
    return static_cast<int>(
        std::count(verdicts.begin() + first, verdicts.begin() + end, Verdict::kDynamic));
  }
};

}  // namespace

TEST_CASE("a cluster goes if half of it is dynamic, and stays if a tenth is") {
  for (const int dynamic : {2, 3, 9, 10}) {
    Scene scene;
    scene.add_column(5.05, 0.05, 0.4, dynamic, Verdict::kDynamic);
    scene.add_column(5.25, 0.05, 0.4, 20 - dynamic, Verdict::kStatic);
    // 2 of 20 are a tenth; 3 and 9 are left as their voxels are; 10 are half of 20.
    CHECK(scene.dynamic(0, 20) == (dynamic == 2 ? 0 : dynamic == 10 ? 20 : dynamic));
    CHECK(scene.dynamic(0, 20, {0}) == 20);  // A track marked it.
  }
}

TEST_CASE("a large group of dynamic points is spared in a static cluster") {
  // A wall of 400 points, and before it 19 or 20 dynamic points: less than a tenth.
  for (const int dynamic : {19, 20}) {
    Scene scene;
    scene.parameters.settled_scans = 0;  // Mixed clusters are not divided.
    for (int y = 0; y < 20; ++y) scene.add_column(5.3, 0.2 * y, 0.4, 20, Verdict::kStatic);
    scene.add_column(5.1, 2.0, 0.4, dynamic, Verdict::kDynamic);
    CHECK(scene.dynamic(0, 400) == 0);
    CHECK(scene.dynamic(400, 400 + dynamic) == (dynamic == 20 ? 20 : 0));
  }
}

TEST_CASE("a person against a wall goes with all of its points") {
  // One cluster: a wall of 400 points with 50 supporting scans, a person of 60 points 0.2 m before
  // it. Two thirds of the person are dynamic, the rest has three supporting scans.
  Scene scene;
  for (int i = 0; i < 40; ++i) {
    for (int k = 0; k < 10; ++k) {
      scene.add({5.3, -4.0 + 0.2 * i, 0.4 + 0.2 * k}, Verdict::kStatic, 50);
    }
  }
  for (int i = 0; i < 60; ++i) {
    const bool low = i < 20;
    scene.add({5.1, 0.02 * (i % 10), 0.4 + 0.2 * (i / 10)},
              low ? Verdict::kStatic : Verdict::kDynamic, low ? 3 : 2);
  }
  CHECK(scene.dynamic(0, 400) == 0);
  CHECK(scene.dynamic(400, 460) == 60);
  // Not divided, the person is a group in a wall: its dynamic points are removed, its feet are
  // kept.
  scene.parameters.settled_scans = 0;
  CHECK(scene.dynamic(0, 460) == 40);
}

TEST_CASE("what stands on a dynamic part goes with it, what stands beside it does not") {
  // 25 dynamic points from 0.4 to 0.8 m and 40 points with 30 supporting scans: fewer than half are
  // dynamic, so that the cluster is mixed. A person stopped near the sensor: scans observed the
  // place of his legs as free before he came, and no scan observed the place of his head, from 0.9
  // m on.
  const auto add_legs = [](Scene& scene) {
    for (int i = 0; i < 5; ++i) scene.add_column(3.1, 0.1 + 0.2 * i, 0.4, 5, Verdict::kDynamic);
  };
  const auto add_settled = [](Scene& scene, double x, double low) {
    for (int i = 0; i < 5; ++i) {
      for (int k = 0; k < 8; ++k) {
        scene.add({x, 0.1 + 0.2 * i, low + 0.1 * k}, Verdict::kStatic, 30);
      }
    }
  };
  Scene person;
  add_legs(person);
  add_settled(person, 3.1, 0.9);
  CHECK(person.dynamic(0, 65) == 65);
  // A wall right behind the legs is on the ground: half of its points are lower than their mean.
  Scene wall;
  add_legs(wall);
  add_settled(wall, 3.3, 0.4);
  CHECK(wall.dynamic(0, 25) == 25);
  CHECK(wall.dynamic(25, 65) == 0);
  // Points at the height of the head, but two voxels away from the legs, are not above them.
  Scene hedge;
  hedge.parameters.cluster_gap = 0.6;
  add_legs(hedge);
  add_settled(hedge, 3.5, 0.9);
  CHECK(hedge.dynamic(0, 25) == 25);
  CHECK(hedge.dynamic(25, 65) == 0);
}

TEST_CASE("tracks may follow what was divided as it was before, unless hardly any of it moves") {
  // 25 dynamic points and a row with 30 supporting scans, right behind them and as high.
  for (const int settled : {40, 400}) {
    Scene scene;
    for (int i = 0; i < 5; ++i) scene.add_column(3.1, 0.1 + 0.2 * i, 0.4, 5, Verdict::kDynamic);
    for (int k = 0; k < settled; ++k) {
      scene.add({3.3, 0.1 * (k % 10), 0.4 + 0.1 * (k / 10 % 4)}, Verdict::kStatic, 30);
    }
    const auto objects = scene.objects();
    const auto undivided = std::find_if(objects.begin(), objects.end(),
                                        [](const auto& object) { return object.is_undivided; });
    CHECK(scene.dynamic(0, 25 + settled) == 25);
    if (settled == 400) {  // 25 of 425 are less than a tenth.
      CHECK(undivided == objects.end());
      continue;
    }
    REQUIRE(undivided != objects.end());
    REQUIRE(objects.size() == 3);  // The others are the row, and what is before it.
    CHECK(undivided->points == objects[0].points + objects[1].points);
    CHECK(undivided->dynamic == 25);
    CHECK(undivided->low == objects[0].low.cwiseMin(objects[1].low));
    CHECK(undivided->high == objects[0].high.cwiseMax(objects[1].high));
    CHECK(undivided->agree_scans == 30.0F);
    // The verdict of a track holds for all of its points.
    CHECK(scene.dynamic(0, 65, {undivided->cluster}) == 65);
    CHECK(scene.dynamic(0, 65, {objects[1].cluster}) == 25);
  }
}

TEST_CASE("what tracks get of a cluster is its box, its mean and how many scans agree with it") {
  Scene scene;
  scene.add_column(4.05, 3.05, 0.4, 4, Verdict::kDynamic);
  scene.add_column(4.25, 3.05, 0.4, 4, Verdict::kStatic);   // three supporting scans
  scene.add_column(9.05, 3.05, 0.4, 3, Verdict::kDynamic);  // too few points
  for (std::size_t k = 4; k < 8; ++k) {
    scene.map.evidence(scene.scan.voxel[k]) = k < 6 ? VoxelEvidence{3, 3, 0, 0, 75'000, 75'008}
                                                    : VoxelEvidence{0, 3, 0, 0, 75'004, 75'010};
  }
  const auto objects = scene.objects();
  REQUIRE(objects.size() == 1);
  CHECK(objects[0].cluster == 0);
  CHECK(objects[0].points == 8);
  CHECK(objects[0].dynamic == 4);
  CHECK(objects[0].agree_scans == 3.0F);
  CHECK(objects[0].free_scans == 1.5F);
  CHECK(objects[0].first_agree == 75'002.0);
  CHECK(objects[0].last_agree == 75'009.0);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int k = 0; k < 8; ++k)
    sum += scene.scan.scan.points[static_cast<std::size_t>(k)].cast<double>();
  CHECK(objects[0].center.isApprox(sum / 8.0));
  CHECK(objects[0].center.isApprox(Eigen::Vector3d(4.15, 3.05, 0.55), 1e-7));  // They are floats.
  CHECK(objects[0].width() == Approx(0.2));
}

namespace {

/// The number of removed points of a pole, of 12. Beside it, in the same cluster, is a person of 20
/// dynamic points. It is scan 50.
/// @param person evidence on the voxel of the person's point k
int gone_of_pole(const std::function<VoxelEvidence(std::size_t)>& person, VoxelEvidence pole,
                 const std::vector<int>& marked = {}) {
  Scene scene;
  scene.scan.scan.index = 50;
  scene.add_column(5.05, 0.05, 0.4, 20, Verdict::kDynamic);
  scene.add_column(5.25, 0.05, 0.4, 12, Verdict::kStatic);
  for (std::size_t k = 0; k < 32; ++k) {
    scene.map.evidence(scene.scan.voxel[k]) = k < 20 ? person(k) : pole;
  }
  CHECK(scene.dynamic(0, 20, marked) == 20);
  return scene.dynamic(20, 32, marked);
}

}  // namespace

TEST_CASE("a pole stays where somebody stands beside it") {
  // Five scans support the person, 40 to 60.
  const auto pole_goes = [](VoxelEvidence pole, const std::vector<int>& marked = {}) {
    const auto person = [](std::size_t) { return VoxelEvidence{10, 5, 0, 0, 40, 60}; };
    const int gone = gone_of_pole(person, pole, marked);
    CHECK((gone == 0 || gone == 12));
    return gone == 12;
  };
  // Both are there for 21 scans. All of the 20 scans before and after must support the pole.
  CHECK_FALSE(pole_goes({0, 41, 0, 0, 30, 70}));
  CHECK(pole_goes({0, 40, 0, 0, 30, 70}));
  CHECK_FALSE(pole_goes({0, 41, 0, 0, 20, 60}));  // All may be before, ...
  CHECK_FALSE(pole_goes({0, 41, 0, 0, 40, 80}));  // ... or all after.
  CHECK(pole_goes({0, 21, 0, 0, 40, 60}));        // It came and left with the person.
  CHECK_FALSE(pole_goes({0, 30, 0, 0, 0, 29}));   // It left before the person came.
  // Of 130 scans before and after, 104 must support it.
  CHECK_FALSE(pole_goes({0, 125, 0, 0, 0, 150}));
  CHECK(pole_goes({0, 124, 0, 0, 0, 150}));
  CHECK_FALSE(pole_goes({6, 125, 0, 0, 0, 150}));  // A twentieth of the scans may be free.
  CHECK(pole_goes({7, 125, 0, 0, 0, 150}));
  CHECK(pole_goes({0, 41, 0, 0, 30, 70}, {0}));  // A marked cluster is removed as a whole.
}

TEST_CASE("a pole stays beside what was there for different times") {
  // Half of the person's points were there from scan 40 to 60, and half from 30 to 70: from 35 to
  // 65 on average, and with a standard deviation of 5 before and after from 30 to 70. All of the
  // twenty scans from 20 to 80 that are not among these 41 must support the pole.
  const auto person = [](std::size_t k) {  // Two points that follow each other have one voxel.
    return k / 2 % 2 == 0 ? VoxelEvidence{10, 5, 0, 0, 30, 70} : VoxelEvidence{10, 5, 0, 0, 40, 60};
  };
  CHECK(gone_of_pole(person, {0, 61, 0, 0, 20, 80}) == 0);
  CHECK(gone_of_pole(person, {0, 60, 0, 0, 20, 80}) == 12);
}

TEST_CASE("points that nobody has seen before are of their own scan's time") {
  // The dynamic points have no supporting scan, only scan 50. The other points need twenty.
  const auto person = [](std::size_t) { return VoxelEvidence{10, 0, 0, 0, 0, 0}; };
  CHECK(gone_of_pole(person, {0, 21, 0, 0, 40, 60}) == 0);
  CHECK(gone_of_pole(person, {0, 20, 0, 0, 40, 60}) == 12);
}

TEST_CASE("what is too sparse for the sensor that saw it is not followed, all else is") {
  // Six points 0.28 m apart, in a box of 1.0 x 0.2 m 5 m away, and a column.
  Scene scene;
  for (int i = 0; i < 6; ++i) scene.add({5.05, 0.2 * i, 0.4 + 0.2 * (i % 2)}, Verdict::kDynamic);
  scene.add_column(9.05, 3.05, 0.4, 6, Verdict::kDynamic);
  const auto followed = [&](const DirectionSteps& steps) {
    std::vector<int> clusters;
    for (const ObjectSummary& object : scene.objects(steps)) {
      clusters.push_back(object.cluster);
    }
    return clusters;
  };
  CHECK(followed({}) == std::vector<int>{0, 1});
  CHECK(followed({0.02F, 0.02F}) == std::vector<int>{0, 1});  // Of 20 directions into the box.
  CHECK(followed({0.002F, 0.002F}) == std::vector<int>{1});   // Of 2,000.
}

TEST_CASE("a fragment goes with what goes beside it") {
  // An object of 6 points at x = 5.05 m, y = 0.05 m, and beside it 3 points without free scans. The
  // reach is 2.5 x (0.3 m + 0.01 x their range), 0.881 m at 5.22 m.
  for (const double apart : {0.6, 0.86, 0.90}) {
    for (const int points : {3, 4}) {  // Four are an object of their own.
      for (const bool goes : {true, false}) {
        Scene scene;
        const Verdict own = goes ? Verdict::kDynamic : Verdict::kStatic;
        scene.add_column(5.05, 0.05, 0.85, 6, own);
        scene.add_column(5.05, 0.05 + apart, 1.0, points, Verdict::kStatic);
        const bool follows = goes && points == 3 && apart < 0.9;
        CHECK(scene.dynamic(0, 6) == (goes ? 6 : 0));
        CHECK(scene.dynamic(6, 6 + points) == (follows ? 3 : 0));
        if (goes) continue;
        // A track marked the object: the fragment is removed and stored with it.
        const bool is_fragment = points == 3 && apart < 0.9;
        const SegmentedScan scan = scene.segmented();
        const int marked = scan.cluster_of[0];
        CHECK(scene.dynamic(6, 6 + points, {marked}) == (is_fragment ? 3 : 0));
        const auto objects = summarise_objects(scan, scene.map, {}, scene.parameters, RunContext{});
        std::size_t remembered = 0;
        for (const PointRun& run : remembered_points(scan, objects, scene.parameters)) {
          if (objects[run.object].cluster == marked) remembered += run.count;
        }
        CHECK(remembered == (is_fragment ? 9 : 6));
      }
    }
  }
}

TEST_CASE("a fragment does not go with another, nor with what is too wide to be one thing") {
  Scene pair;
  pair.add_column(5.05, 0.05, 1.0, 3, Verdict::kDynamic);
  pair.add_column(5.05, 0.65, 1.0, 3, Verdict::kStatic);
  CHECK(pair.dynamic(0, 3) == 3);
  CHECK(pair.dynamic(3, 6) == 0);
  for (const int columns : {60, 90}) {  // 11.8 m and 17.8 m long; 15 m are the most.
    Scene wide;
    for (int n = 0; n < columns; ++n) {
      wide.add_column(5.05, 0.2 * n - 0.1 * columns, 1.0, 2, Verdict::kDynamic);
    }
    wide.add({5.65, 0.05, 1.0}, Verdict::kStatic);
    CHECK(wide.dynamic(2 * columns, 2 * columns + 1) == (columns == 60 ? 1 : 0));
  }
}

TEST_CASE("low points follow what stands above them, if two thirds of that agree") {
  // Feet at 0.1 m and 0.2 m, and a leg of ten points from 0.3 m on, of which some are dynamic.
  for (const int dynamic : {3, 5, 7}) {
    Scene scene;
    for (const double z : {0.1, 0.25}) scene.add({5.05, 0.05, z}, Verdict::kDynamic);
    scene.add({5.05, 0.05, 0.15}, Verdict::kStatic);
    for (int k = 0; k < 10; ++k) {  // In the column beside.
      scene.add({5.05, 0.25, 0.3 + 0.06 * k}, k < dynamic ? Verdict::kDynamic : Verdict::kStatic);
    }
    // Points higher than 1 m and 0.03 of their range, 0.16 m, are not above these points.
    for (int k = 0; k < 100; ++k) scene.add({5.05, 0.05, 1.17 + 0.01 * k}, Verdict::kDynamic);
    const Verdicts decided = scene.with_low_points();
    const auto feet = std::count(decided.begin(), decided.begin() + 3, Verdict::kDynamic);
    CHECK(feet == (dynamic == 3   ? 0
                   : dynamic == 5 ? 2
                                  : 3));  // With half of it they are as they were.
    CHECK(std::equal(decided.begin() + 3, decided.end(), scene.scan.verdict.begin() + 3));
  }
}

TEST_CASE("far away, low points follow what stands higher up and farther aside") {
  // 30 m away, 1.9 m are 1 m and 0.03 times the range. Beams 2 degrees apart are 1.05 m apart
  // there, and 0.6 of that are three more columns than the neighbouring column.
  struct Standing {
    double high, aside;
    bool is_followed;
  };
  const float beams_apart = GENERATE(0.0349F, 0.0F);
  for (const double range : {30.05, 5.05}) {
    for (const auto& [high, aside, is_followed] :
         {Standing{1.85, 0.0, true}, {1.95, 0.0, false}, {0.5, 0.8, true}, {0.5, 1.0, false}}) {
      for (const double side : {-1.0, 1.0}) {
        Scene scene;
        scene.maps.steps.elevation = beams_apart;
        scene.add({range, 0.05, 0.1}, Verdict::kStatic);
        scene.add({range, 0.05 + side * aside, high}, Verdict::kDynamic);
        const Verdicts verdicts = scene.with_low_points();
        CAPTURE(range, high, aside, side, beams_apart);
        const bool is_near = aside == 0.0 || beams_apart > 0.0F;
        CHECK((verdicts[0] == Verdict::kDynamic) == (is_followed && is_near && range > 30.0));
      }
    }
  }
}

TEST_CASE("a drop of rain near by takes no low points along, and what has two points does") {
  // Two columns 0.0035 apart fit into 10 cm up to 14.3 m. Points farther than 80 m are not checked.
  struct Above {
    double range;
    int points;
    float step;
    bool is_followed;
  };
  for (const auto& [range, points, step, is_followed] : {Above{70.05, 1, 1e-6F, false},
                                                         {90.05, 1, 1e-6F, true},
                                                         {5.05, 1, 0.0035F, false},
                                                         {5.05, 2, 0.0035F, true},
                                                         {14.05, 1, 0.0035F, false},
                                                         {14.65, 1, 0.0035F, true},
                                                         {5.05, 1, 0.0F, true},
                                                         {5.05, 1, 0.02F, true}}) {
    Scene scene;
    scene.maps.steps.azimuth = step;
    scene.add({range, 0.05, 0.1}, Verdict::kStatic);
    for (int k = 0; k < points; ++k) scene.add({range, 0.05, 0.5 + 0.1 * k}, Verdict::kDynamic);
    CAPTURE(range, points, step);
    CHECK((scene.with_low_points()[0] == Verdict::kDynamic) == is_followed);
  }
}

TEST_CASE("a point above those of a foot is no drop") {
  // 5 m away, a point must be within 0.117 m.
  for (const double foot : {0.25, 0.2}) {
    Scene scene;
    scene.maps.steps.azimuth = 0.0035F;
    scene.add({5.05, 0.05, foot}, Verdict::kStatic);
    scene.add({5.05, 0.05, 0.34}, Verdict::kDynamic);
    CHECK((scene.with_low_points()[0] == Verdict::kDynamic) == (foot > 0.22));
  }
}

TEST_CASE("two drops are two lone points, unless they are as near as points of one thing") {
  // A third of 0.3 m and of 0.01 of their range, 5.08 m, is 0.117 m.
  for (const double apart : {0.11, 0.12}) {
    Scene scene;
    scene.maps.steps.azimuth = 0.0035F;
    scene.add({5.05, 0.05, 0.1}, Verdict::kStatic);
    for (const double z : {0.5, 0.5 + apart}) scene.add({5.05, 0.05, z}, Verdict::kDynamic);
    CHECK((scene.with_low_points()[0] == Verdict::kDynamic) == (apart < 0.115));
  }
}

TEST_CASE("what is told to be a drop depends on the gap of clusters, with and without objects") {
  // The two points are 0.11 m apart. A third of 0.25 m and of 0.01 of their range is 0.1 m, and of
  // 0.3 m and 0.005 of it 0.108 m.
  const auto is_followed = [](Parameters parameters) {
    Scene scene;
    scene.parameters = parameters;
    scene.maps.steps.azimuth = 0.0035F;
    scene.add({5.05, 0.05, 0.1}, Verdict::kStatic);
    for (const double z : {0.5, 0.61}) scene.add({5.05, 0.05, z}, Verdict::kDynamic);
    return scene.with_low_points()[0] == Verdict::kDynamic;
  };
  for (const bool objects : {true, false}) {
    for (const bool low_points : {true, false}) {
      Parameters usual, nearer, slower;
      usual.objects = nearer.objects = slower.objects = objects;
      usual.low_points = nearer.low_points = slower.low_points = low_points;
      nearer.cluster_gap = 0.25;
      slower.cluster_growth = 0.005;
      CHECK(is_followed(usual) == low_points);
      CHECK_FALSE(is_followed(nearer));
      CHECK_FALSE(is_followed(slower));
      for (const char* const name : {"cluster_gap", "cluster_growth"}) {
        const ParameterSpec& spec =
            find_parameter("raymoval_plus", parameter_table().specs(), name);
        CHECK(has_effect(spec, parameter_table().write(usual)) == (objects || low_points));
      }
    }
  }
}

TEST_CASE("however far apart beams are, low points look no more than twenty columns aside") {
  for (const double aside : {4.0, 4.2}) {
    Scene scene;
    scene.maps.steps.elevation = 0.5F;  // 15 m apart at that range.
    scene.add({30.05, 0.05, 0.1}, Verdict::kStatic);
    scene.add({30.05, 0.05 + aside, 0.5}, Verdict::kDynamic);
    CHECK((scene.with_low_points()[0] == Verdict::kDynamic) == (aside < 4.1));
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
        scene.add_column(5.05, 0.25, 0.35, 6, leg);  // Beside it.
        Verdicts expected = scene.scan.verdict;
        // The mean is unchanged, within 1 mm. Points in voxels observed as free stay dynamic, with
        // any points above them.
        if (leg == Verdict::kDynamic) expected[3] = Verdict::kDynamic;
        CHECK(scene.with_low_points() == expected);
      }
    }
  }
}

TEST_CASE("what was no ground when it was seen follows what moves above it") {
  for (const bool ground_evidence : {true, false}) {  // Without it, the ground is always kept.
    Scene scene;
    scene.parameters.ground_evidence = ground_evidence;
    scene.add({5.05, 0.05, 0.01}, Verdict::kStatic);
    scene.scan.voxel.back() = EvidenceMap::kNone;  // Nor has it a voxel of the ground.
    scene.add_column(5.05, 0.05, 0.35, 6, Verdict::kDynamic);
    const Verdicts verdicts = scene.with_low_points();
    CHECK(verdicts[0] == (ground_evidence ? Verdict::kDynamic : Verdict::kStatic));
  }
}

namespace {

/// How far the points that are ground lie above the mean of all in their cells of 0.4 m; metres.
std::vector<double> slow_above_ground(const LocatedScan& scan) {
  // In 256ths of a cell's edge.
  const auto height = [&](std::size_t k) {
    return (scan.in_map.z[k] * 256 + static_cast<int>(scan.in_map.parts[k] >> 16U)) >> 1;
  };
  std::map<std::array<int, 3>, std::array<double, 2>> cells;  // Sum and count.
  const auto cell_of = [&](std::size_t k) {
    return std::array{scan.in_map.x[k] >> 1, scan.in_map.y[k] >> 1, scan.in_map.z[k] >> 1};
  };
  std::vector<double> above(scan.voxel.size());
  for (std::size_t k = 0; k < above.size(); ++k) {
    if (scan.voxel[k] != EvidenceMap::kNone) continue;
    cells[cell_of(k)][0] += height(k);
    cells[cell_of(k)][1] += 1.0;
  }
  for (std::size_t k = 0; k < above.size(); ++k) {
    const auto& [sum, count] = cells[cell_of(k)];
    above[k] = (height(k) - sum / count) * 0.4 / 256.0;
  }
  return above;
}

/// The points that no other one above the ground is near.
std::vector<bool> slow_lone_points(const LocatedScan& scan, float steps) {
  std::vector<bool> is_alone(scan.voxel.size(), false);
  for (std::size_t k = 0; k < is_alone.size(); ++k) {
    if (scan.voxel[k] == EvidenceMap::kNone) continue;
    is_alone[k] = scan.scan.points[k].norm() <= 0.05F / steps;
    for (std::size_t other = 0; other < is_alone.size(); ++other) {
      if (other == k || scan.voxel[other] == EvidenceMap::kNone) continue;
      const Eigen::Vector3f &a = scan.scan.points[k], &b = scan.scan.points[other];
      const float reach = (0.3F + 0.01F * std::min(a.norm(), b.norm())) / 3.0F;
      if ((a - b).norm() <= reach) is_alone[k] = false;
    }
  }
  return is_alone;
}

/// Step 8 with every column counted. 1 for each point that is dynamic afterwards.
std::vector<int> slow_low_points(const LocatedScan& scan, const Verdicts& before, float low,
                                 const DirectionSteps& steps) {
  std::vector<bool> is_standing(before.size());
  for (std::size_t k = 0; k < before.size(); ++k) {
    const float range = scan.scan.points[k].norm();
    is_standing[k] = scan.height[k] >= low && scan.height[k] < 1.0F + 0.03F * range;
  }
  std::map<std::pair<int, int>, std::array<int, 2>> standing;  // Fixed and dynamic points.
  const std::vector<bool> is_alone = slow_lone_points(scan, steps.azimuth);
  for (std::size_t k = 0; k < before.size(); ++k) {
    if (!is_standing[k] || (is_alone[k] && before[k] == Verdict::kDynamic)) continue;
    ++standing[{scan.in_map.x[k], scan.in_map.y[k]}][before[k] == Verdict::kDynamic ? 1 : 0];
  }
  const std::vector<double> above_ground = slow_above_ground(scan);
  std::vector<int> dynamic(before.size());
  for (std::size_t k = 0; k < before.size(); ++k) {
    dynamic[k] = before[k] == Verdict::kDynamic ? 1 : 0;
    const bool is_ground = scan.voxel[k] == EvidenceMap::kNone;
    if (is_ground ? above_ground[k] < 0.01 : scan.height[k] >= low) continue;
    const int reach =
        1 + static_cast<int>(scan.scan.points[k].norm() * 0.6F * steps.elevation / 0.2F);
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
    scene.maps.steps = {0.0035F, 0.035F};
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
    const std::vector<int> expected = slow_low_points(
        scene.scan, before, static_cast<float>(scene.parameters.object_height), scene.maps.steps);
    for (std::size_t k = 0; k < decided.size(); ++k) {
      REQUIRE((decided[k] == Verdict::kDynamic) == (expected[k] == 1));
      if ((before[k] == Verdict::kDynamic) == (expected[k] == 1)) continue;
      ++changed;
      if (scene.scan.voxel[k] == EvidenceMap::kNone) ++changed_ground;
    }
  }
  CHECK(changed > 50);
  CHECK(changed_ground > 20);
}

TEST_CASE("low points follow whatever they reach, whichever of it comes first") {
  // 16 beams: points up to 9.55 m away reach one column aside, those beyond reach two.
  const Eigen::Vector3d low(9.59, 0.45, 0.1), near(9.42, 0.05, 0.5), far(9.59, 0.05, 0.5);
  const std::vector<std::vector<Eigen::Vector3d>> all_above = {{near, far}, {far, near}, {near}};
  for (const std::vector<Eigen::Vector3d>& above : all_above) {
    Scene scene;
    scene.maps.steps.elevation = 0.0349F;
    scene.add(low, Verdict::kStatic);
    for (const Eigen::Vector3d& at : above) scene.add(at, Verdict::kDynamic);
    CHECK(scene.with_low_points()[0] == Verdict::kDynamic);
  }
}

TEST_CASE("the points of what a track may mark are remembered") {
  Scene scene;
  scene.add_column(4.05, 3.05, 0.4, 6, Verdict::kStatic);   // points 0 to 5, few supporting scans
  scene.add_column(9.05, 3.05, 0.4, 6, Verdict::kDynamic);  // dynamic by itself
  scene.add_column(14.05, 3.05, 0.4, 5, Verdict::kStatic);  // points 12 to 16
  scene.add_column(4.25, 3.05, 0.4, 4, Verdict::kStatic);   // points 17 to 20, of the first
  for (int k = 0; k < 6; ++k) scene.add({19.05, 3.05, 0.4 + 0.1 * k}, Verdict::kStatic, 500);
  const SegmentedScan scan = scene.segmented();
  const auto objects = summarise_objects(scan, scene.map, {}, scene.parameters, RunContext{});
  REQUIRE(objects.size() == 4);
  std::map<int, std::vector<std::uint32_t>> points;  // By cluster.
  for (const PointRun& run : remembered_points(scan, objects, scene.parameters)) {
    for (std::uint32_t k = 0; k < run.count; ++k) {
      points[objects[run.object].cluster].push_back(run.first + k);
    }
  }
  const std::map<int, std::vector<std::uint32_t>> expected{{0, {0, 1, 2, 3, 4, 5, 17, 18, 19, 20}},
                                                           {2, {12, 13, 14, 15, 16}}};
  CHECK(points == expected);
}

TEST_CASE("nothing is remembered that has no number") {
  ObjectSummary object;
  object.points = 6;
  const std::vector<ObjectSummary> objects(65'537, object);
  CHECK(is_remembered(objects, 65'534, Parameters{}));
  CHECK_FALSE(is_remembered(objects, 65'535, Parameters{}));
  CHECK_FALSE(is_remembered(objects, 65'536, Parameters{}));
}

TEST_CASE("what is wider than track_width is not followed") {
  Scene scene;  // 2 m wide.
  for (int n = 0; n < 11; ++n) scene.add_column(5.05, 0.2 * n + 0.05, 0.4, 4, Verdict::kDynamic);
  for (const double width : {1.9, 2.1}) {
    scene.parameters.track_width = width;
    const auto objects = scene.objects();
    CHECK(objects.size() == (width > 2.0 ? 1 : 0));
  }
}

TEST_CASE("a part with few dynamic points neither goes as a whole nor is marked for its track") {
  // A wall of 400 points with 50 supporting scans. Before it are 29 or 30 points, of which 19 or 20
  // are dynamic. Aside are further dynamic points, so that more than a tenth of all are dynamic,
  // but not half.
  for (const int dynamic : {19, 20}) {
    Scene scene;
    for (int y = -10; y < 10; ++y) {
      for (int k = 0; k < 20; ++k)
        scene.add({5.3, 0.2 * y + 0.05, 0.4 + 0.1 * k}, Verdict::kStatic, 50);
    }
    scene.add_column(5.05, -1.55, 0.4, dynamic, Verdict::kDynamic);
    scene.add_column(5.05, -1.35, 0.4, 10, Verdict::kUndecided);
    scene.add_column(5.05, 1.45, 0.4, 30, Verdict::kDynamic);
    const SegmentedScan scan = scene.segmented();
    const int part = scan.cluster_of[400];
    REQUIRE(scan.clusters[static_cast<std::size_t>(part)].is_part);
    CHECK(scene.dynamic(400, 400 + dynamic + 10) == (dynamic == 20 ? 30 : 19));
    // For its track it is dynamic either way, and tracks mark only what is not.
    const auto objects = summarise_objects(scan, scene.map, {}, scene.parameters, RunContext{});
    const auto found = std::find_if(objects.begin(), objects.end(),
                                    [&](const auto& object) { return object.cluster == part; });
    REQUIRE(found != objects.end());
    CHECK(is_dynamic(*found, scene.parameters));
  }
}

TEST_CASE("the reason for a verdict is the step that made it") {
  // Eight voxels, and three of the ground: whether it was observed as free, then the result of the
  // vote, of the objects, and of the low points.
  struct Story {
    bool seen_through, voted, object, removed;
    const char* reason;
  };
  const std::vector<Story> stories{
      {false, false, false, false, "no scan, or too few, saw through its voxel"},
      {true, true, true, true, "scans saw through its voxel, more than agree with it allow"},
      {false, true, true, true, "most of the decided voxels around its own were seen through"},
      {true, false, false, false,
       "its voxel was seen through, but few of the voxels around it were"},
      {true, false, true, true,
       "it belongs to an object that was seen moving or is mostly seen through"},
      {true, true, false, false, "it belongs to an object that hardly anything was seen through"},
      {false, false, false, true, "what stands above it moved"},
      {true, true, true, false, "what stands above it stays"},
      {false, false, false, false, "it is ground, or was when its scan came"},
      {true, false, false, false, "it is ground, or was when its scan came"},
      {true, true, true, true, "scans saw through its voxel, more than agree with it allow"}};
  const auto verdict = [](bool dynamic) { return dynamic ? Verdict::kDynamic : Verdict::kStatic; };
  Scene scene;
  SegmentedScan scan;
  Verdicts by_objects, decided;
  for (std::size_t k = 0; k < stories.size(); ++k) {
    scene.add({5.1 + static_cast<double>(k), 0.1, 0.1}, verdict(stories[k].seen_through));
    scan.verdict.push_back(verdict(stories[k].voted));
    by_objects.push_back(verdict(stories[k].object));
    decided.push_back(verdict(stories[k].removed));
  }
  scan.voxel = scene.scan.voxel;
  scan.ground_voxel.assign(stories.size(), EvidenceMap::kNone);
  EvidenceMaps maps(scene.parameters);
  maps.standing = scene.map;
  EvidenceMap::Blocks::Cursor cursor;
  for (std::size_t k = stories.size() - 3; k < stories.size(); ++k) {  // The ground.
    scan.voxel[k] = EvidenceMap::kNone;
    scan.ground_voxel[k] = maps.ground.add({static_cast<int>(k), 0, 0}, 0, cursor);
    maps.ground.set_decision(scan.ground_voxel[k], verdict(stories[k].seen_through));
  }
  const auto reasons = reasons_for(scan, maps, by_objects, decided);
  const auto sentences = reason_sentences();
  for (std::size_t k = 0; k < stories.size(); ++k) {
    CHECK(sentences.at(reasons[k]) == stories[k].reason);
  }
}

}  // namespace raymoval::raymoval_plus_test
