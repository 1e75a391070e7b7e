// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/raymoval_plus.h"

#include <catch2/catch.hpp>

#include "methods/raymoval_plus/evidence_map.h"
#include "methods/raymoval_plus/range_image.h"
#include "methods/raymoval_plus/terrain.h"
#include "methods/raymoval_plus/tracks.h"
#include "methods/raymoval_plus/verdicts.h"
#include "tests/methods/moved_world.h"

using namespace raymoval;

namespace {

ConfiguredMethod plus(const Configuration& settings = {}) {
  ConfiguredMethod method = MethodRegistry::built_in().configure("raymoval_plus");
  for (const auto& [name, value] : settings) set_parameter(method.configuration, name, value);
  return method;
}

SensorModel half_degree_sensor() {
  return toy::Scanner{}.model();
}

/// A walker of half a metre who moves 0.2 m a scan along x; `dynamic` of 20 points are dynamic.
ObjectSummary walker(int scan, int dynamic, double agree_scans) {
  ObjectSummary object;
  object.center = {0.2 * scan, 0.0, 1.0};
  object.low = object.center - Eigen::Vector3d(0.25, 0.25, 0.7);
  object.high = object.center + Eigen::Vector3d(0.25, 0.25, 0.7);
  object.range = 10.0;
  object.points = 20;
  object.dynamic = dynamic;
  object.agree_scans = agree_scans;
  return object;
}

}  // namespace

TEST_CASE("a place agrees with, hides behind or stands in front of a return") {
  Scan scan;
  scan.points.emplace_back(10.0F, 0.0F, 0.0F);
  RangeImage image(half_degree_sensor(), RaymovalPlusParameters{});
  image.fill(scan);
  CHECK(image.test({10.1F, 0.0F, 0.0F}) == Seen::kAgree);     // 0.1 <= 0.2 + 0.005 * 10.1
  CHECK(image.test({11.0F, 0.0F, 0.0F}) == Seen::kOccluded);  // the return is 1 m nearer
  CHECK(image.test({5.0F, 0.0F, 0.0F}) == Seen::kFree);       // the return is 5 m farther
  // 0.27 m is more than 0.2 + 0.005 * 9.73, but 10 < 9.73 + 0.25 + 0.005 * 9.73.
  CHECK(image.test({9.73F, 0.0F, 0.0F}) == Seen::kOccluded);
  CHECK(image.test({0.0F, 5.0F, 0.0F}) == Seen::kUnknown);  // no return that way
}

TEST_CASE("agreement saves before occlusion abstains before freedom counts") {
  Scan scan;
  for (const float range : {4.0F, 10.0F, 30.0F}) scan.points.emplace_back(range, 0.0F, 0.0F);
  RangeImage image(half_degree_sensor(), RaymovalPlusParameters{});
  image.fill(scan);
  CHECK(image.test({30.0F, 0.0F, 0.0F}) == Seen::kAgree);     // the farthest of the bin
  CHECK(image.test({10.0F, 0.0F, 0.0F}) == Seen::kOccluded);  // a middle one is not kept
  CHECK(image.test({3.0F, 0.0F, 0.0F}) == Seen::kFree);
}

TEST_CASE("a return above a place does not make it free") {
  Scan scan;  // Two rows of half a step above the place: within the window, not at or below it.
  scan.points.emplace_back(10.0F, 0.0F, 10.0F * std::tan(0.5F * 0.01745329F));
  RangeImage image(half_degree_sensor(), RaymovalPlusParameters{});
  image.fill(scan);
  CHECK(image.test({5.0F, 0.0F, 0.0F}) == Seen::kUnknown);
  CHECK(image.test({5.0F, 0.0F, 5.0F * std::tan(0.5F * 0.01745329F)}) == Seen::kFree);
}

TEST_CASE("scans that see through are weighed against scans that agree") {
  EvidenceMap map(0.2);
  for (int i = 0; i < 5; ++i) map.add({0.1 + 10.0 * i, 0.1, 0.1});
  map.freeze();
  RaymovalPlusParameters parameters;
  parameters.run_scans = 0;
  //                      free, agree: needed = 1 + 0.3 agree
  const int cases[5][2] = {{1, 0}, {3, 10}, {4, 10}, {0, 1}, {0, 2}};
  std::vector<Evidence> found;
  for (std::size_t v = 0; v < map.size(); ++v) {
    const auto number = static_cast<std::size_t>(map.centroid(v).x() / 10.0);
    map.free_scans[v] = static_cast<std::uint16_t>(cases[number][0]);
    map.agree_scans[v] = static_cast<std::uint16_t>(cases[number][1]);
  }
  decide_voxels(map, parameters);
  for (int i = 0; i < 5; ++i) {
    found.push_back(map.evidence[map.find(voxel_key(map.index_of({0.1 + 10.0 * i, 0.1, 0.1})))]);
  }
  CHECK(found == std::vector<Evidence>{Evidence::kDynamic, Evidence::kStatic, Evidence::kDynamic,
                                       Evidence::kUndecided, Evidence::kStatic});
}

TEST_CASE("neighbours outvote a voxel within three cells and no farther") {
  EvidenceMap map(0.2);
  // Dynamic voxels at 0, 1, 2 and 3 cells; a static one at 6, an undecided one at 10.
  for (const int cell : {0, 1, 2, 3, 6, 10}) map.add({0.2 * cell + 0.1, 0.1, 0.1});
  map.freeze();
  for (std::size_t v = 0; v < map.size(); ++v) {
    const int cell = voxel_index(map.key(v)).x();
    map.evidence[v] = cell <= 3   ? Evidence::kDynamic
                      : cell == 6 ? Evidence::kStatic
                                  : Evidence::kUndecided;
  }
  vote(map, RaymovalPlusParameters{}, 1);
  const auto at = [&](int cell) { return map.evidence[map.find(voxel_key(cell, 0, 0))]; };
  CHECK(at(0) == Evidence::kDynamic);
  CHECK(at(6) == Evidence::kDynamic);  // one dynamic voxel (3) of two within 3 cells: the half
  CHECK(at(10) == Evidence::kUndecided);
}

TEST_CASE("ground is the low quantile, without pits and walls") {
  RaymovalPlusParameters parameters;
  Terrain terrain(parameters);
  for (int x = -20; x <= 20; ++x) {
    for (int y = -20; y <= 20; ++y) {
      for (int k = 0; k < 4; ++k) {
        const double z = x == 5 && y == 5 ? -3.0 : -1.7;  // one column of false echoes
        terrain.add({0.4 * x + 0.05 + 0.08 * k, 0.4 * y + 0.2, z});
      }
    }
  }
  terrain.finish(1);
  CHECK(terrain.height({0.1, 0.1, -1.7}) == Approx(0.0).margin(0.05));
  CHECK(terrain.height({2.2, 2.2, 0.3}) == Approx(2.0).margin(0.3));  // beside the pit
  CHECK(std::isinf(terrain.height({100.0, 0.0, 0.0})));
}

TEST_CASE("an object is followed past its last evidence, a standing one is not") {
  RaymovalPlusParameters parameters;
  std::vector<std::vector<ObjectSummary>> scans;
  for (int i = 0; i < 10; ++i) {
    // Nothing was seen after the last three scans, so their voxels are not found free.
    scans.push_back({walker(i, i < 7 ? 18 : 0, 4.0), walker(0, 0, 10.0)});
    scans.back()[1].center.y() += 5.0;
  }
  const auto marks = objects_on_tracks(scans, parameters);
  for (int i = 0; i < 10; ++i) {
    const auto& of_scan = marks[static_cast<std::size_t>(i)];
    CHECK(of_scan[0] == (i < 7 ? 0 : 1));
    CHECK(of_scan[1] == 0);
  }
  // Scans agree on it for far longer than half a metre at 0.2 m a scan explains: something else.
  for (auto& objects : scans) objects[0].agree_scans = 60.0;
  CHECK(objects_on_tracks(scans, parameters)[9][0] == 0);
}

TEST_CASE("raymoval_plus takes the movers off a street and leaves the rest") {
  const toy::World world = toy::street(16);
  const MaskStore masks = toy::masks_of(*plus().make(), world);
  // The car drives off ahead: its last places are hidden by itself.
  CHECK(toy::removed_share(world, masks, 3, 0, 15) > 0.7);
  CHECK(toy::removed_share(world, masks, 4, 0, 15) > 0.99);
  for (const int fixed : {0, 1}) CHECK(toy::removed_share(world, masks, fixed, 0, 15) < 0.001);
  // The person walks past the pole within reach of the vote.
  CHECK(toy::removed_share(world, masks, 2, 0, 15) < 0.1);
}

TEST_CASE("raymoval_plus answers the same on any number of threads") {
  const toy::World world = toy::street(10);
  const MaskStore one = toy::masks_of(*plus().make(), world, 1);
  for (const int threads : {2, 8}) {
    CHECK(toy::different_verdicts(one, toy::masks_of(*plus().make(), world, threads), 10) == 0);
  }
}

TEST_CASE("raymoval_plus takes no scans, empty scans and single points") {
  toy::World none{toy::Scanner{}};
  CHECK(toy::masks_of(*plus().make(), none).removed_count() == 0);
  toy::World empty{toy::Scanner{}};
  empty.scan({}, Pose::Identity());
  empty.scan({{{5.0, -0.01, -0.01}, {5.1, 0.05, 0.05}}}, Pose::Identity());
  CHECK(toy::masks_of(*plus().make(), empty).removed_count() == 0);
}

TEST_CASE("raymoval_plus depends on the lattice of its voxels within bounds") {
  const toy::World world = toy::street(10);
  std::size_t points = 0;
  for (std::size_t i = 0; i < world.size(); ++i) points += world.load(i).size();
  const auto changed =
      toy::verdicts_changed_by(toy::whole_motion(0.07, 0.11, 0.05, 0), plus(), world);
  CHECK(static_cast<double>(changed) < 0.02 * static_cast<double>(points));
}
