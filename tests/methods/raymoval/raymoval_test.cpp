// SPDX-License-Identifier: MIT
#include "methods/raymoval/raymoval.h"

#include <catch2/catch.hpp>
#include <numbers>

#include "core/text.h"
#include "methods/registry.h"
#include "tests/methods/toy_world.h"

namespace raymoval::raymoval_test {
using namespace raymoval::raymoval_method;
using toy::Box;
using toy::World;

namespace {

// A wall 12 m ahead and a box of car size 6 m ahead. The sensor stands off the lattice.
const Box kWall{{12.03, -9, -3}, {12.5, 9, 3}};
const Box kCar{{6.03, -1, -1}, {8, 1, 0.6}};
const Box kPole{{7.03, -0.05, -3}, {7.13, 0.05, 3}};
constexpr int kWallOwner = 0;
constexpr int kOtherOwner = 1;

Pose pose_at(double x, double y, double z) {
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(x, y, z);
  return pose;
}

/// Five scans of the wall with the box, then five without (or the other way round).
World box_that(bool leaves, const toy::Scanner& scanner = {}, const Pose& move = Pose::Identity(),
               const Pose& sensor_turn = Pose::Identity()) {
  World world(scanner);
  const auto moved = [&](const Box& box) {
    return Box{box.low + move.translation(), box.high + move.translation()};
  };
  for (int i = 0; i < 10; ++i) {
    std::vector<Box> boxes = {moved(kWall)};
    if ((i < 5) == leaves) boxes.push_back(moved(kCar));
    world.scan(boxes, move * pose_at(0.013 * i + 0.01, 0.02, 0.03) * sensor_turn);
  }
  return world;
}

/// One bin per beam and two beams per bin along a row: the toy scanner needs no more.
ConfiguredMethod configured(const std::string& variant) {
  ConfiguredMethod method = MethodRegistry::built_in().configure("raymoval:" + variant);
  set_parameter(method.configuration, "azimuth_bins", std::int64_t{360});
  set_parameter(method.configuration, "elevation_bins", std::int64_t{44});
  return method;
}

MaskStore run(const std::string& variant, const World& world, int threads = 1) {
  return toy::masks_of(*configured(variant).make(), world, threads);
}

}  // namespace

TEST_CASE("a box that leaves is removed from every scan, the wall behind it stays") {
  const World world = box_that(true);
  const MaskStore masks = run("offline", world);
  CHECK(toy::removed_share(world, masks, kOtherOwner, 0, 4) > 0.95);
  CHECK(toy::removed_share(world, masks, kWallOwner, 0, 9) < 0.01);
}

TEST_CASE("a box that arrives stands in front of the map and is flagged at once") {
  const World world = box_that(false);
  const MaskStore masks = run("online", world);
  // The front is at 6 m: 12 - 6 is more than 0.3 + 0.35 * 6.
  CHECK(toy::removed_share(world, masks, kOtherOwner, 5, 9) > 0.95);
  CHECK(toy::removed_share(world, masks, kWallOwner, 0, 9) < 0.01);
}

TEST_CASE("online knows nothing of later scans") {
  const World world = box_that(true);
  const MaskStore masks = run("online", world);
  CHECK(toy::removed_share(world, masks, kOtherOwner, 0, 4) == 0.0);
}

TEST_CASE("beams far apart are no witnesses for each other") {
  // A sign hangs at the range of the box, 1.5 degrees above it, and stays when the box leaves. A
  // window from one beam to the next, 4 degrees either way, would find it and keep the box.
  const Box sign{{6.03, -1, 0.8}, {6.3, 1, 1.0}};
  const Box low_box{{6.03, -1, -0.6}, {8, 1, 0.6}};
  for (const double step : {0.0, 0.5, 4.0}) {
    INFO(step);
    toy::Scanner scanner;
    scanner.elevation_step = step;
    World world(scanner);
    for (int i = 0; i < 10; ++i) {
      std::vector<Box> boxes = {kWall, sign};
      if (i < 5) boxes.push_back(low_box);
      world.scan(boxes, pose_at(0.013 * i + 0.01, 0.02, 0.03));
    }
    CHECK(toy::removed_share(world, run("offline", world), 2, 0, 4) > 0.75);
    ConfiguredMethod method = configured("offline");
    set_parameter(method.configuration, "erase_elevation_window", std::int64_t{8});
    CHECK(toy::removed_share(world, toy::masks_of(*method.make(), world), 2, 0, 4) < 0.5);
  }
}

TEST_CASE("a box that stays is static") {
  World world{toy::Scanner{}};
  for (int i = 0; i < 8; ++i) world.scan({kWall, kCar}, pose_at(0.013 * i + 0.01, 0.02, 0.03));
  for (const char* variant :
       {"offline", "online", "offline-growing", "offline-naive", "table1", "table1-growing"}) {
    INFO(variant);
    const MaskStore masks = run(variant, world);
    CHECK(toy::removed_share(world, masks, kOtherOwner, 0, 7) < 0.01);
    CHECK(toy::removed_share(world, masks, kWallOwner, 0, 7) < 0.01);
  }
}

TEST_CASE("a thin pole before a wall is not seen through by its neighbours") {
  // The pole is half as wide as a voxel: most rays into its voxels go past it to the wall.
  World world{toy::Scanner{}};
  for (int i = 0; i < 8; ++i) world.scan({kWall, kPole}, pose_at(0.05 * i + 0.01, 0.02, 0.03));
  const MaskStore masks = run("offline", world);
  CHECK(toy::removed_share(world, masks, kOtherOwner, 0, 7) < 0.05);
}

TEST_CASE("a road that lies low in its voxels stays whole while the sensor drives over it") {
  // The surface is 2 cm above a voxel wall: rays cross up to 0.18 m of empty height in its voxels.
  const Box road{{-40, -6, -2}, {60, 6, -1.38}};
  World world{toy::Scanner{}};
  for (int i = 0; i < 20; ++i) world.scan({kWall, road}, pose_at(0.37 * i - 8, 0.02, 0.03));
  const MaskStore masks = run("offline", world);
  CHECK(toy::removed_share(world, masks, kOtherOwner, 0, 19) < 0.02);
  // The distance along the surface is what saves it.
  ConfiguredMethod method = configured("offline");
  set_parameter(method.configuration, "erase_height", 0.0);
  CHECK(toy::removed_share(world, toy::masks_of(*method.make(), world), kOtherOwner, 0, 19) > 0.05);
}

TEST_CASE("against the prior map eq. 11 decides by its margin") {
  // Once the box has left, the scans see the wall through where it stood: the prior has the wall
  // only. The box's front is at about 6 m, the wall twice as far, so the rays would go on for
  // about as far as they went. That is more than 0.3 + 0.35 * 6 and less than 0.3 + 1 * 6.
  const World world = box_that(true);
  ConfiguredMethod method = configured("offline");
  set_parameter(method.configuration, "erased_points", false);  // Nothing but eq. 11.
  const auto share = [&](int owner) {
    return toy::removed_share(world, toy::masks_of(*method.make(), world), owner, 0, 4);
  };
  CHECK(share(kOtherOwner) > 0.95);
  CHECK(share(kWallOwner) < 0.01);
  set_parameter(method.configuration, "tau1", 1.0);
  CHECK(share(kOtherOwner) == 0.0);
  set_parameter(method.configuration, "tau1", 0.35);
  set_parameter(method.configuration, "tau0", 6.0);
  CHECK(share(kOtherOwner) == 0.0);
  set_parameter(method.configuration, "tau0", 0.3);
  set_parameter(method.configuration, "forward_test", false);
  CHECK(share(kOtherOwner) == 0.0);
}

TEST_CASE("eq. 11 finds what is left of a box that was seen through in part") {
  // The wall ends at 0.3 m, so nothing lies behind the upper half of the box: when it has left, no
  // return tells that its voxels are empty. Beside what was seen through, eq. 11 finds its edge.
  const Box low_wall{{12.03, -9, -3}, {12.5, 9, 0.3}};
  World world{toy::Scanner{}};
  for (int i = 0; i < 10; ++i) {
    std::vector<Box> boxes = {low_wall};
    if (i < 5) boxes.push_back(kCar);
    world.scan(boxes, pose_at(0.013 * i + 0.01, 0.02, 0.03));
  }
  ConfiguredMethod method = configured("offline");
  const auto share = [&] {
    return toy::removed_share(world, toy::masks_of(*method.make(), world), kOtherOwner, 0, 4);
  };
  const double with_forward_test = share();
  set_parameter(method.configuration, "forward_test", false);
  const double without = share();
  CHECK(without > 0.3);
  CHECK(with_forward_test > without);
  // Against the map of all points eq. 11 says nothing.
  CHECK(toy::removed_share(world, run("offline-naive", world), kOtherOwner, 0, 4) == without);
}

TEST_CASE("without eq. 11 the prior map gives what the naive one does") {
  const World world = box_that(true);
  ConfiguredMethod prior = configured("offline");
  set_parameter(prior.configuration, "forward_test", false);
  const MaskStore masks = toy::masks_of(*prior.make(), world), naive = run("offline-naive", world);
  for (std::size_t i = 0; i < world.size(); ++i) REQUIRE(masks.get(i) == naive.get(i));
}

TEST_CASE("a prior map is seen through for good, whatever a growing one may do") {
  const World world = box_that(true);
  ConfiguredMethod method = configured("offline");
  set_parameter(method.configuration, "forward_test", false);
  set_parameter(method.configuration, "permanent_erase", false);
  CHECK(toy::removed_share(world, toy::masks_of(*method.make(), world), kOtherOwner, 0, 4) > 0.95);
}

TEST_CASE("online, what stands where a scan has seen through is removed") {
  // The box comes back. Without eq. 11 only what was seen through tells that it moves.
  World world{toy::Scanner{}};
  for (int i = 0; i < 12; ++i) {
    std::vector<Box> boxes = {kWall};
    if (i < 4 || i >= 8) boxes.push_back(kCar);
    world.scan(boxes, pose_at(0.013 * i + 0.01, 0.02, 0.03));
  }
  ConfiguredMethod method = configured("online");
  set_parameter(method.configuration, "forward_test", false);
  const auto share = [&] {
    return toy::removed_share(world, toy::masks_of(*method.make(), world), kOtherOwner, 8, 11);
  };
  CHECK(share() > 0.95);
  set_parameter(method.configuration, "erased_points", false);
  CHECK(share() == 0.0);
}

TEST_CASE("what never came into a growing map is removed from it") {
  const World world = box_that(false);
  CHECK(toy::removed_share(world, run("offline-growing", world), kOtherOwner, 5, 9) > 0.95);
}

TEST_CASE("a sensor that sees only ahead judges only what it sees") {
  toy::Scanner scanner;
  scanner.azimuth_from = -30;
  scanner.azimuth_to = 30;
  const World world = box_that(true, scanner);
  const MaskStore masks = run("offline", world);
  CHECK(toy::removed_share(world, masks, kOtherOwner, 0, 4) > 0.95);
  CHECK(toy::removed_share(world, masks, kWallOwner, 0, 9) < 0.01);
}

TEST_CASE("an upside-down sensor gives the same verdicts") {
  Pose turn = Pose::Identity();
  turn.linear() = Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()).matrix();
  const World world = box_that(true, {}, Pose::Identity(), turn);
  const MaskStore masks = run("offline", world);
  CHECK(toy::removed_share(world, masks, kOtherOwner, 0, 4) > 0.95);
  CHECK(toy::removed_share(world, masks, kWallOwner, 0, 9) < 0.01);
}

TEST_CASE("far from the origin nothing changes") {
  // A shift by whole voxels moves the lattice onto itself.
  const World near = box_that(true);
  const World far = box_that(true, {}, pose_at(400000 * 0.2, -250000 * 0.2, 500 * 0.2));
  const MaskStore near_masks = run("offline", near);
  const MaskStore far_masks = run("offline", far);
  std::size_t points = 0, different = 0;
  for (std::size_t i = 0; i < near.size(); ++i) {
    const Mask a = near_masks.get(i), b = far_masks.get(i);
    REQUIRE(a.size() == b.size());
    points += a.size();
    for (std::size_t k = 0; k < a.size(); ++k) different += a[k] != b[k] ? 1 : 0;
  }
  // Points within float rounding of a voxel wall may change sides.
  CHECK(different * 1000 < points);
}

TEST_CASE("empty directions erase only where they are asked to, and not at the first time") {
  // The box stands before nothing at all; when it leaves, its directions fall silent.
  World world{toy::Scanner{}};
  const Box side{{-9, 6.03, -3}, {9, 6.5, 3}};
  for (int i = 0; i < 10; ++i) {
    std::vector<Box> boxes = {side};
    if (i < 4) boxes.push_back(kCar);
    world.scan(boxes, pose_at(0.013 * i + 0.01, 0.02, 0.03));
  }
  CHECK(toy::removed_share(world, run("offline", world), kOtherOwner, 0, 3) == 0.0);
  ConfiguredMethod method = configured("offline");
  set_parameter(method.configuration, "no_return", true);
  set_parameter(method.configuration, "no_return_scans", std::int64_t{3});
  const auto share = [&] {
    const MaskStore masks = toy::masks_of(*method.make(), world);
    CHECK(toy::removed_share(world, masks, kWallOwner, 0, 9) < 0.01);
    return toy::removed_share(world, masks, kOtherOwner, 0, 3);
  };
  CHECK(share() > 0.8);
  set_parameter(method.configuration, "no_return_scans", std::int64_t{7});  // Only six are silent.
  CHECK(share() == 0.0);
  // So it is in a growing map, where validation runs beside the search for evidence.
  method = configured("offline-growing");
  set_parameter(method.configuration, "no_return", true);
  set_parameter(method.configuration, "no_return_scans", std::int64_t{7});
  CHECK(share() == 0.0);
  set_parameter(method.configuration, "no_return_scans", std::int64_t{3});
  CHECK(share() > 0.8);
}

TEST_CASE("an erased voxel stays erased, or may be filled again") {
  // The box comes back after the map was seen through where it stood.
  World world{toy::Scanner{}};
  for (int i = 0; i < 12; ++i) {
    std::vector<Box> boxes = {kWall};
    if (i < 4 || i >= 8) boxes.push_back(kCar);
    world.scan(boxes, pose_at(0.013 * i + 0.01, 0.02, 0.03));
  }
  ConfiguredMethod method = configured("offline");
  set_parameter(method.configuration, "map_source", std::string("growing"));
  set_parameter(method.configuration, "forward_test", false);
  CHECK(toy::removed_share(world, toy::masks_of(*method.make(), world), kOtherOwner, 8, 11) > 0.95);
  set_parameter(method.configuration, "permanent_erase", false);
  CHECK(toy::removed_share(world, toy::masks_of(*method.make(), world), kOtherOwner, 8, 11) < 0.05);
}

TEST_CASE("a backward pass sees what arrives as something that leaves") {
  // Growing map without the forward test: the box that arrives is never seen through forwards.
  const World world = box_that(false);
  ConfiguredMethod method = configured("offline");
  set_parameter(method.configuration, "map_source", std::string("growing"));
  set_parameter(method.configuration, "forward_test", false);
  CHECK(toy::removed_share(world, toy::masks_of(*method.make(), world), kOtherOwner, 5, 9) == 0.0);
  set_parameter(method.configuration, "backward_pass", true);
  CHECK(toy::removed_share(world, toy::masks_of(*method.make(), world), kOtherOwner, 5, 9) > 0.95);
}

TEST_CASE("an online run cannot have a map of all scans") {
  ConfiguredMethod method = MethodRegistry::built_in().configure("raymoval:online");
  for (const char* source : {"naive", "prior"}) {
    set_parameter(method.configuration, "map_source", std::string(source));
    CHECK_THROWS_WITH(method.make(), Catch::Contains("growing"));
  }
}

TEST_CASE("table1 uses every printed value in both tests") {
  const auto variant =
      GENERATE(as<std::string>(), "table1", "table1-online", "table1-growing", "table1-naive");
  const auto method = MethodRegistry::built_in().configure("raymoval:" + variant);
  const Parameters p = parameter_table().read(method.configuration);
  CHECK(p.azimuth_bins == 720);
  CHECK(p.elevation_bins == 450);
  CHECK(p.maximum_range == 60.0);
  CHECK(p.voxel_size == 0.2);
  CHECK(p.neighbourhood == 1);
  CHECK(p.percentile == 0.9);
  CHECK(p.tau0 == 0.3);
  CHECK(p.tau1 == 0.35);
  CHECK(p.erase_tau0 == 0.3);
  CHECK(p.erase_tau1 == 0.35);
  CHECK(p.erase_percentile == 0.9);
}

}  // namespace raymoval::raymoval_test
