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

/// Margins so wide that eq. 11 flags nothing.
void switch_eq11_off(ConfiguredMethod& method) {
  set_parameter(method.configuration, "tau0", 10.0);
  set_parameter(method.configuration, "tau1", 2.0);
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
  for (const char* variant : {"offline", "online", "table1"}) {
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

TEST_CASE("eq. 11 decides by its margin") {
  // The box's front arrives at 6 m, and the wall of the map is twice as far: the rays would go on
  // for as far as they went. That is more than 0.3 + 0.35 * 6 and less than 0.3 + 1 * 6.
  const World world = box_that(false);
  const auto share = [&](double tau0, double tau1) {
    ConfiguredMethod method = configured("online");
    set_parameter(method.configuration, "tau0", tau0);
    set_parameter(method.configuration, "tau1", tau1);
    return toy::removed_share(world, toy::masks_of(*method.make(), world), kOtherOwner, 5, 9);
  };
  CHECK(share(0.3, 0.35) > 0.95);
  CHECK(share(0.3, 1.0) == 0.0);
  CHECK(share(6.0, 0.35) == 0.0);
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
  const double with_eq11 = share();
  switch_eq11_off(method);
  const double without = share();
  CHECK(without > 0.3);
  CHECK(with_eq11 > without);
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
  switch_eq11_off(method);
  CHECK(toy::removed_share(world, toy::masks_of(*method.make(), world), kOtherOwner, 8, 11) > 0.95);
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

TEST_CASE("directions without return erase nothing") {
  // The box stands before nothing at all; when it leaves, its directions have no returns.
  World world{toy::Scanner{}};
  const Box side{{-9, 6.03, -3}, {9, 6.5, 3}};
  for (int i = 0; i < 10; ++i) {
    std::vector<Box> boxes = {side};
    if (i < 4) boxes.push_back(kCar);
    world.scan(boxes, pose_at(0.013 * i + 0.01, 0.02, 0.03));
  }
  CHECK(toy::removed_share(world, run("offline", world), kOtherOwner, 0, 3) == 0.0);
}

TEST_CASE("table1 uses every printed value in both tests") {
  const auto method = MethodRegistry::built_in().configure("raymoval:table1");
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
