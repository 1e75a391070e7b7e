// SPDX-License-Identifier: MIT
// The whole method on a box before a wall.
#include <catch2/catch.hpp>
#include <numbers>

#include "tests/methods/moved_world.h"
#include "tests/methods/raymoval/box_scenes.h"

namespace raymoval::raymoval_test {

namespace {

const Box kWall = wall(), kCar = car();
const Box kPole{{7.03, -0.05, -3}, {7.13, 0.05, 3}};

/// Five scans of the wall with the box, then five without.
World box_that_leaves(const toy::Scanner& scanner = {}, const Pose& turn = Pose::Identity()) {
  return box_before(
      {kWall}, kCar, 10, [](int i) { return i < 5; }, scanner, turn);
}

/// The other way round.
World box_that_arrives() {
  return box_before({kWall}, kCar, 10, [](int i) { return i >= 5; });
}

/// Margins so wide that eq. 11 flags nothing.
void switch_eq11_off(ConfiguredMethod& method) {
  set_parameter(method.configuration, "tau0", 10.0);
  set_parameter(method.configuration, "tau1", 2.0);
}

MaskStore run(const std::string& variant, const World& world, int threads = 1) {
  return toy::masks_of(*on_toy_grid(variant).make(), world, threads);
}

}  // namespace

TEST_CASE("a box that leaves is removed from every scan, the wall behind it stays") {
  // Seen by a scanner that sees all around, by one that sees only ahead, and upside down.
  toy::Scanner ahead;
  ahead.azimuth_from = -30;
  ahead.azimuth_to = 30;
  const Pose upside_down(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()));
  for (const World& world :
       {box_that_leaves(), box_that_leaves(ahead), box_that_leaves({}, upside_down)}) {
    const MaskStore masks = run("offline", world);
    CHECK(toy::removed_share(world, masks, kOtherOwner, 0, 4) > 0.95);
    CHECK(toy::removed_share(world, masks, kWallOwner, 0, 9) < 0.01);
  }
}

TEST_CASE("a box that arrives stands in front of the map and is flagged at once") {
  const World world = box_that_arrives();
  const MaskStore masks = run("online", world);
  // The front is at 6 m: 12 - 6 is more than 0.3 + 0.35 * 6.
  CHECK(toy::removed_share(world, masks, kOtherOwner, 5, 9) > 0.95);
  CHECK(toy::removed_share(world, masks, kWallOwner, 0, 9) < 0.01);
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
    const World world = box_before(
        {kWall, sign}, low_box, 10, [](int i) { return i < 5; }, scanner);
    CHECK(toy::removed_share(world, run("offline", world), 2, 0, 4) > 0.75);
    ConfiguredMethod method = on_toy_grid("offline");
    set_parameter(method.configuration, "erase_elevation_window", std::int64_t{8});
    CHECK(toy::removed_share(world, toy::masks_of(*method.make(), world), 2, 0, 4) < 0.5);
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
  ConfiguredMethod method = on_toy_grid("offline");
  set_parameter(method.configuration, "erase_height", 0.0);
  CHECK(toy::removed_share(world, toy::masks_of(*method.make(), world), kOtherOwner, 0, 19) > 0.05);
}

TEST_CASE("eq. 11 decides by its margin") {
  // The box's front arrives at 6 m, and the wall of the map is twice as far: the rays would go on
  // for as far as they went. That is more than 0.3 + 0.35 * 6 and less than 0.3 + 1 * 6.
  const World world = box_that_arrives();
  const auto share = [&](double tau0, double tau1) {
    ConfiguredMethod method = on_toy_grid("online");
    set_parameter(method.configuration, "tau0", tau0);
    set_parameter(method.configuration, "tau1", tau1);
    return toy::removed_share(world, toy::masks_of(*method.make(), world), kOtherOwner, 5, 9);
  };
  CHECK(share(0.3, 0.35) > 0.95);
  CHECK(share(0.3, 1.0) == 0.0);
  CHECK(share(6.0, 0.35) == 0.0);
}

TEST_CASE("eq. 11 finds what is left of a box that was seen through in part") {
  // The wall ends at 0.3 m, so there is no surface behind the upper half of the box: when it has
  // left, no return shows that its voxels are empty. Beside the erased voxels, eq. 11 finds its
  // edge.
  const World world = box_before({wall(0.3)}, kCar, 10, [](int i) { return i < 5; });
  ConfiguredMethod method = on_toy_grid("offline");
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
  // The box comes back. Without eq. 11, only erased voxels show that it moves.
  const World world = box_before({kWall}, kCar, 12, [](int i) { return i < 4 || i >= 8; });
  ConfiguredMethod method = on_toy_grid("online");
  switch_eq11_off(method);
  CHECK(toy::removed_share(world, toy::masks_of(*method.make(), world), kOtherOwner, 8, 11) > 0.95);
}

TEST_CASE("directions without return erase nothing") {
  // There is no surface behind the box; when it leaves, its directions have no returns.
  const Box side{{-9, 6.03, -3}, {9, 6.5, 3}};
  const World world = box_before({side}, kCar, 10, [](int i) { return i < 4; });
  CHECK(toy::removed_share(world, run("offline", world), kOtherOwner, 0, 3) == 0.0);
}

}  // namespace raymoval::raymoval_test
