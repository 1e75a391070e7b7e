// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/raymoval_plus.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <map>
#include <numbers>
#include <numeric>
#include <random>

#include "core/angle.h"
#include "methods/raymoval_plus/dense_blocks.h"
#include "methods/raymoval_plus/evidence.h"
#include "methods/raymoval_plus/evidence_map.h"
#include "methods/raymoval_plus/objects.h"
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
ObjectSummary walker(int scan, int dynamic, float agree_scans) {
  ObjectSummary object;
  object.center = {0.2 * scan, 0.0, 1.0};
  object.low = object.center - Eigen::Vector3d(0.25, 0.25, 0.7);
  object.high = object.center + Eigen::Vector3d(0.25, 0.25, 0.7);
  object.range = 10.0F;
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

TEST_CASE("steps that no sensor has cost no more memory than the finest sensor") {
  Scan scan;
  scan.points.emplace_back(10.0F, 0.0F, 0.0F);
  for (const double step : {0.0, 1e-300, 1e-9, 1e-4, 3.0}) {
    INFO(step);
    SensorModel sensor = half_degree_sensor();
    sensor.elevation_min = -1.6;
    sensor.elevation_max = 1.6;
    sensor.azimuth_step = sensor.elevation_step = step;
    RangeImage image(sensor, RaymovalPlusParameters{});
    CHECK(image.size() <= 4'000'000);
    CHECK(image.size() >= 90);
    image.fill(scan);
    CHECK(image.test({10.0F, 0.0F, 0.0F}) == Seen::kAgree);
  }
}

TEST_CASE("rows are half a beam high, wherever the field of view ends") {
  // 16 beams 2 degrees apart are 30 rows of 1 degree, and 4 more at either end.
  SensorModel sensor = half_degree_sensor();
  sensor.azimuth_step = 0.2 * kDegree;
  sensor.elevation_step = 2.0 * kDegree;
  sensor.elevation_min = -15.0 * kDegree;
  sensor.elevation_max = 15.0 * kDegree;
  const RangeImage named(sensor, RaymovalPlusParameters{});
  sensor.elevation_max += 0.3 * kDegree;
  const RangeImage seen(sensor, RaymovalPlusParameters{});
  CHECK(named.size() == 38 * 1241);
  CHECK(seen.size() == 39 * 1241);
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

TEST_CASE("places are seen alike one by one, all at once, and by every instruction set") {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> angle(-3.2F, 3.2F), slope(-0.4F, 0.3F), range(1.0F, 90.0F);
  const auto somewhere = [&](float steeper) {
    const float a = angle(random);
    return Eigen::Vector3f(
        range(random) *
        Eigen::Vector3f(std::cos(a), std::sin(a), steeper * slope(random)).normalized());
  };
  Scan scan;
  for (int i = 0; i < 20000; ++i) scan.points.push_back(somewhere(1.0F));
  std::vector<float> places;
  for (int i = 0; i < 50003; ++i) {
    const Eigen::Vector3f place = somewhere(1.5F);
    places.insert(places.end(), place.data(), place.data() + 3);
  }
  const RaymovalPlusParameters parameters;
  std::array<int, 4> found{};
  for (const InstructionSet set : supported_instruction_sets()) {
    RangeImage image(half_degree_sensor(), parameters, set);
    image.fill(scan);
    std::vector<SeenPlace> seen;
    image.see(places, Pose::Identity(), seen);
    auto next = seen.begin();
    for (std::uint32_t k = 0; k < places.size() / 3; ++k) {
      const Eigen::Vector3f place = Eigen::Map<const Eigen::Vector3f>(places.data() + 3 * k);
      const bool near = place.norm() >= static_cast<float>(parameters.evidence_range_min) &&
                        place.norm() <= static_cast<float>(parameters.evidence_range_max);
      const Seen wanted = image.test(place);
      ++found[static_cast<std::size_t>(wanted)];
      const bool told = next != seen.end() && next->place == k;
      REQUIRE(told == (near && (wanted == Seen::kAgree || wanted == Seen::kFree)));
      if (!told) continue;
      REQUIRE(next->seen == wanted);
      ++next;
    }
    CHECK(next == seen.end());
  }
  for (const int count : found) CHECK(count > 100);
}

TEST_CASE("the bins of places are those of atan2 and asin, but for places on their borders") {
  std::mt19937 random(4);
  std::normal_distribution<float> place(0.0F, 20.0F);
  const float columns = 1440.0F, full = 2.0F * std::numbers::pi_v<float>;
  const kernels::SightGrid grid{columns / full, 300.0F, -0.5F, 1440};
  const Pose turned(Eigen::Translation3d(3.0, -2.0, 1.0) *
                    Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()));
  const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> rotation = turned.linear().cast<float>();
  std::vector<Eigen::Vector3f> places(5001);
  for (Eigen::Vector3f& at : places) at = {place(random), place(random), 0.3F * place(random)};
  kernels::SightPlaces job{places.front().data(), places.size(), {}, {3.0F, -2.0F, 1.0F}};
  std::copy_n(rotation.data(), 9, job.rotation.begin());
  for (const InstructionSet set : supported_instruction_sets()) {
    std::vector<float> range(places.size() + 16);
    std::vector<std::int32_t> column(range.size()), row(range.size());
    kernels::sight_kernels_for(set).locate(grid, job, {range.data(), column.data(), row.data()});
    int on_borders = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
      const Eigen::Vector3d at = turned * places[k].cast<double>();
      const double r = at.norm();
      const double x =
          (std::atan2(at.y(), at.x()) + std::numbers::pi) * static_cast<double>(columns / full);
      const double y = (std::asin(at.z() / r) + 0.5) * 300.0;
      REQUIRE(range[k] == Approx(r).epsilon(1e-6));
      // 1e-3 of a bin is 3e-6 radians or more.
      const auto on_border = [](double bin) { return std::abs(bin - std::round(bin)) < 1e-3; };
      if (on_border(x) || on_border(y)) {
        ++on_borders;
        continue;
      }
      REQUIRE(column[k] == static_cast<int>(x));
      REQUIRE(row[k] == static_cast<int>(std::floor(y)));
    }
    CHECK(on_borders < 50);
  }
}

TEST_CASE("a place is looked up where the formulas of azimuth and elevation say") {
  // One return a direction; the same direction agrees, others as far apart as two windows do not.
  const RaymovalPlusParameters parameters;
  for (int degrees = -180; degrees <= 180; degrees += 7) {
    for (const int up : {-9, -3, 0, 8}) {
      const double a = degrees * kDegree, e = up * kDegree;
      const Eigen::Vector3d way(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
      Scan scan;
      scan.points.push_back((20.0 * way).cast<float>());
      RangeImage image(half_degree_sensor(), parameters);
      image.fill(scan);
      CHECK(image.test((20.1 * way).cast<float>()) == Seen::kAgree);
      const double other = a + 8.0 * kDegree;
      const Eigen::Vector3d aside(std::cos(e) * std::cos(other), std::cos(e) * std::sin(other),
                                  std::sin(e));
      CHECK(image.test((20.1 * aside).cast<float>()) == Seen::kUnknown);
    }
  }
}

TEST_CASE("blocks hold what was put into their cells, for either sign") {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> coordinate(-40, 40);
  DenseBlocks<int, 2, 4> blocks(-1);
  DenseBlocks<int, 2, 4>::Cursor cursor, reading;
  std::map<VoxelKey, int> oracle;
  for (int i = 0; i < 5000; ++i) {
    const VoxelIndex cell(coordinate(random), coordinate(random), coordinate(random));
    blocks.make(cell, cursor) = i;
    oracle[voxel_key(cell)] = i;
  }
  for (int i = 0; i < 20000; ++i) {
    const VoxelIndex cell(coordinate(random), coordinate(random), coordinate(random));
    const auto found = oracle.find(voxel_key(cell));
    REQUIRE(blocks.get(cell, reading) == (found == oracle.end() ? -1 : found->second));
  }
  CHECK(blocks.get({1000, 0, 0}, reading) == -1);
}

TEST_CASE("scans that see through are weighed against scans that agree") {
  RaymovalPlusParameters parameters;
  const auto decided = [&](int free, int agree, int leading = 0, int trailing = 0) {
    VoxelEvidence evidence;
    evidence.free_scans = static_cast<std::uint16_t>(free);
    evidence.agree_scans = static_cast<std::uint16_t>(agree);
    evidence.leading_free = static_cast<std::uint16_t>(leading);
    evidence.trailing_free = static_cast<std::uint16_t>(trailing);
    return decide(evidence, parameters);
  };
  // Needed: 1 + 0.3 x the scans that agree.
  CHECK(decided(1, 0) == Evidence::kDynamic);
  CHECK(decided(3, 10) == Evidence::kStatic);
  CHECK(decided(4, 10) == Evidence::kDynamic);
  CHECK(decided(0, 1) == Evidence::kUndecided);
  CHECK(decided(0, 2) == Evidence::kStatic);
  // Or four in a row, before the first or after the last scan that agrees.
  CHECK(decided(4, 100, 4, 0) == Evidence::kDynamic);
  CHECK(decided(4, 100, 0, 4) == Evidence::kDynamic);
  CHECK(decided(6, 100, 3, 3) == Evidence::kStatic);
}

TEST_CASE("runs of scans that see through are counted at either end of a voxel's story") {
  const RaymovalPlusParameters parameters;
  VoxelEvidence evidence;
  for (const Seen seen : {Seen::kFree, Seen::kOccluded, Seen::kFree, Seen::kAgree, Seen::kFree,
                          Seen::kAgree, Seen::kUnknown, Seen::kFree}) {
    count(seen, 10.0, parameters, evidence);
  }
  count(Seen::kFree, 30.0, parameters, evidence);  // Farther than 20 m: not of a run.
  CHECK(evidence.agree_scans == 2);
  CHECK(evidence.free_scans == 5);
  CHECK(evidence.leading_free == 2);
  CHECK(evidence.trailing_free == 1);
}

TEST_CASE("a pole that scans always agreed with stays in a crowd") {
  // Static voxels at cell 0, dynamic ones at the two on either side of each: 4 of 5 votes.
  const RaymovalPlusParameters parameters;
  struct Pole {
    int agree_scans, free_scans;
    Evidence verdict;
  };
  for (const Pole pole : {Pole{parameters.settled_scans, 0, Evidence::kStatic},
                          Pole{parameters.settled_scans - 1, 0, Evidence::kDynamic},
                          Pole{50, 1, Evidence::kDynamic}}) {
    EvidenceMap map(0.2);
    EvidenceMap::Blocks::Cursor cursor;
    for (int cell = -2; cell <= 2; ++cell) {
      const auto voxel = map.add({0.2 * cell + 0.1, 0.1, 0.1}, cursor);
      map.set_decision(voxel, cell == 0 ? Evidence::kStatic : Evidence::kDynamic);
      if (cell != 0) continue;
      map.evidence(voxel).agree_scans = static_cast<std::uint16_t>(pole.agree_scans);
      map.evidence(voxel).free_scans = static_cast<std::uint16_t>(pole.free_scans);
    }
    std::vector<std::uint32_t> blocks(map.blocks().block_count());
    std::iota(blocks.begin(), blocks.end(), 0U);
    vote(blocks, parameters, 1, map);
    CHECK(map.verdict(map.find({0.1, 0.1, 0.1}, cursor)) == pole.verdict);
    CHECK(map.verdict(map.find({0.3, 0.1, 0.1}, cursor)) == Evidence::kDynamic);
  }
}

TEST_CASE("neighbours outvote a voxel within three cells and no farther") {
  EvidenceMap map(0.2);
  EvidenceMap::Blocks::Cursor cursor;
  // Dynamic voxels at 0, 1, 2 and 3 cells; a static one at 6, an undecided one at 10.
  for (const int cell : {0, 1, 2, 3, 6, 10}) {
    map.set_decision(map.add({0.2 * cell + 0.1, 0.1, 0.1}, cursor), cell <= 3 ? Evidence::kDynamic
                                                                    : cell == 6
                                                                        ? Evidence::kStatic
                                                                        : Evidence::kUndecided);
  }
  std::vector<std::uint32_t> blocks(map.blocks().block_count());
  std::iota(blocks.begin(), blocks.end(), 0U);
  vote(blocks, RaymovalPlusParameters{}, 1, map);
  const auto at = [&](int cell) {
    return map.verdict(map.find({0.2 * cell + 0.1, 0.1, 0.1}, cursor));
  };
  CHECK(at(0) == Evidence::kDynamic);
  CHECK(at(6) == Evidence::kDynamic);  // one dynamic voxel (3) of two within 3 cells: the half
  CHECK(at(10) == Evidence::kUndecided);
}

TEST_CASE("votes are those of a count over all voxels, whatever the radius") {
  std::mt19937 random(7);
  EvidenceMap map(0.2);
  EvidenceMap::Blocks::Cursor cursor;
  std::uniform_int_distribution<int> place(-11, 12), kind(0, 5);
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3d point(place(random), place(random), place(random));
    const auto voxel = map.add(0.2 * (point + Eigen::Vector3d::Constant(0.5)), cursor);
    const int k = kind(random);
    map.set_decision(voxel, k == 0   ? Evidence::kUndecided
                            : k == 1 ? Evidence::kDynamic
                                     : Evidence::kStatic);
  }
  std::vector<std::uint32_t> blocks(map.blocks().block_count());
  std::iota(blocks.begin(), blocks.end(), 0U);
  const int radius = GENERATE(1, 2, 3, 4, 5, 8);
  RaymovalPlusParameters parameters;
  parameters.vote_radius = radius;
  parameters.vote_share = parameters.vote_keep = 0.2;
  vote(blocks, parameters, 2, map);
  int wrong = 0, dynamic_verdicts = 0;
  for (std::size_t v = 0; v < map.size(); ++v) {
    int decided = 0, dynamic = 0;
    for (std::size_t w = 0; w < map.size(); ++w) {
      if ((map.index(v) - map.index(w)).cwiseAbs().maxCoeff() > radius) continue;
      decided += map.decision(w) != Evidence::kUndecided ? 1 : 0;
      dynamic += map.decision(w) == Evidence::kDynamic ? 1 : 0;
    }
    const bool expected = decided > 0 && dynamic >= 0.2 * decided;
    wrong += expected != (map.verdict(v) == Evidence::kDynamic) ? 1 : 0;
    dynamic_verdicts += expected ? 1 : 0;
  }
  CHECK(wrong == 0);
  CHECK(dynamic_verdicts > 100);
  CHECK(dynamic_verdicts < static_cast<int>(map.size()) - 100);
}

TEST_CASE("ground is the low quantile, without pits and walls") {
  RaymovalPlusParameters parameters;
  Terrain terrain(parameters);
  std::vector<Eigen::Vector3d> points;
  for (int x = -20; x <= 20; ++x) {
    for (int y = -20; y <= 20; ++y) {
      for (int k = 0; k < 4; ++k) {
        const double z = x == 5 && y == 5 ? -3.0 : -1.7;  // one column of false echoes
        points.emplace_back(0.4 * x + 0.05 + 0.08 * k, 0.4 * y + 0.2, z);
      }
    }
  }
  terrain.add(points);
  terrain.update(1);
  Terrain::Heights::Cursor cursor;
  CHECK(terrain.height({0.1, 0.1, -1.7}, cursor) == Approx(0.0).margin(0.05));
  CHECK(terrain.height({2.2, 2.2, 0.3}, cursor) == Approx(2.0).margin(0.3));  // beside the pit
  CHECK(std::isinf(terrain.height({100.0, 0.0, 0.0}, cursor)));
}

TEST_CASE("ground found scan by scan is the ground found at once") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-60.0, 60.0), rough(0.0, 0.3);
  Terrain at_once{RaymovalPlusParameters{}}, in_parts{RaymovalPlusParameters{}};
  std::vector<Eigen::Vector3d> all;
  for (int scan = 0; scan < 5; ++scan) {
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 40000; ++i) {
      const double x = place(random), y = place(random);
      points.emplace_back(x, y, 0.1 * x + rough(random));
    }
    in_parts.add(points);
    in_parts.update(2);
    all.insert(all.end(), points.begin(), points.end());
  }
  at_once.add(all);
  at_once.update(1);
  Terrain::Heights::Cursor a, b;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d point(place(random), place(random), 0.0);
    REQUIRE(at_once.height(point, a) == in_parts.height(point, b));
  }
}

TEST_CASE("an object is followed past its last evidence, a standing one is not") {
  RaymovalPlusParameters parameters;
  std::vector<std::vector<ObjectSummary>> scans;
  for (int i = 0; i < 10; ++i) {
    // Nothing was seen after the last three scans, so their voxels are not found free.
    scans.push_back({walker(i, i < 7 ? 18 : 0, 4.0), walker(0, 0, 10.0)});
    scans.back()[1].center.y() += 5.0;
  }
  const auto marked = objects_on_tracks(scans, parameters);
  for (int i = 0; i < 10; ++i) {
    CHECK(marked[static_cast<std::size_t>(i)] == (i < 7 ? std::vector<int>{} : std::vector{0}));
  }
  // Scan by scan: the walker of scan 7 is marked by its own past.
  Follower follower(parameters);
  for (std::size_t i = 0; i < 8; ++i) follower.step(i, scans[i]);
  CHECK(follower.marked_now() == std::vector{0});
  // Scans agree on it for far longer than half a metre at 0.2 m a scan explains: something else.
  for (auto& objects : scans) objects[0].agree_scans = 60.0F;
  CHECK(objects_on_tracks(scans, parameters)[9].empty());
}

TEST_CASE("a person against a wall goes with all of its points") {
  // One cluster: a wall of 400 points that 50 scans agree with, a person of 60 points 0.2 m before
  // it. Two thirds of the person are dynamic, the rest three scans agree with.
  const RaymovalPlusParameters parameters;
  EvidenceMap map(parameters.voxel_size);
  EvidenceMap::Blocks::Cursor cursor;
  WorldScan world;
  const auto add = [&](const Eigen::Vector3d& point, Evidence verdict, int agree) {
    const std::uint32_t voxel = map.add(point, cursor);
    map.evidence(voxel).agree_scans = static_cast<std::uint16_t>(agree);
    map.set_verdict(voxel, verdict);
    world.points.push_back(point);
    world.scan.points.push_back(point.cast<float>());
    world.height.push_back(static_cast<float>(point.z()));
    world.voxel.push_back(voxel);
    world.verdict.push_back(verdict);
  };
  for (int i = 0; i < 40; ++i) {
    for (int k = 0; k < 10; ++k) add({5.3, -4.0 + 0.2 * i, 0.4 + 0.2 * k}, Evidence::kStatic, 50);
  }
  for (int i = 0; i < 60; ++i) {
    const bool low = i < 20;
    add({5.1, 0.02 * (i % 10), 0.4 + 0.2 * (i / 10)}, low ? Evidence::kStatic : Evidence::kDynamic,
        low ? 3 : 2);
  }
  const ScanObjects objects = find_objects(world, map, parameters);
  judge_objects(objects, {}, parameters, world);
  const auto removed = removed_points(world);
  CHECK(std::count(removed.begin(), removed.begin() + 400, 1) == 0);
  CHECK(std::count(removed.begin() + 400, removed.end(), 1) == 60);

  // Not divided, the person is a group in a wall: its dynamic points go, its feet stay.
  RaymovalPlusParameters undivided = parameters;
  undivided.settled_scans = 0;
  for (std::size_t k = 0; k < world.voxel.size(); ++k) {
    world.verdict[k] = map.verdict(world.voxel[k]);
  }
  judge_objects(find_objects(world, map, undivided), {}, undivided, world);
  const auto partly = removed_points(world);
  CHECK(std::count(partly.begin(), partly.end(), 1) == 40);
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
  for (const char* const name :
       {"raymoval_plus:offline", "raymoval_plus:online", "raymoval_plus:online-map"}) {
    const ConfiguredMethod method = MethodRegistry::built_in().configure(name);
    const MaskStore one = toy::masks_of(*method.make(), world, 1);
    CHECK(one.removed_count() > 0);
    for (const int threads : {2, 8}) {
      CHECK(toy::different_verdicts(one, toy::masks_of(*method.make(), world, threads), 10) == 0);
    }
  }
}

TEST_CASE("raymoval_plus online knows nothing of later scans") {
  const ConfiguredMethod method = MethodRegistry::built_in().configure("raymoval_plus:online");
  const MaskStore all = toy::masks_of(*method.make(), toy::street(12));
  const MaskStore some = toy::masks_of(*method.make(), toy::street(7));
  CHECK(toy::different_verdicts(some, all, 7) == 0);
}

TEST_CASE("one pass removes nearly what four do") {
  const toy::World world = toy::street(16);
  const ConfiguredMethod method = MethodRegistry::built_in().configure("raymoval_plus:online-map");
  const MaskStore masks = toy::masks_of(*method.make(), world);
  CHECK(toy::removed_share(world, masks, 4, 0, 15) > 0.9);
  for (const int fixed : {0, 1}) CHECK(toy::removed_share(world, masks, fixed, 0, 15) < 0.005);
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
