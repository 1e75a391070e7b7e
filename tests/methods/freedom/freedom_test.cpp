// SPDX-License-Identifier: MIT
#include "methods/freedom/freedom.h"

#include <catch2/catch.hpp>
#include <limits>

#include "core/error.h"
#include "tests/methods/toy_world.h"

namespace raymoval::freedom_test {
using namespace raymoval::freedom_method;

namespace {

/// A wall behind a box, before a stationary sensor: the box is there in the first `with` scans.
toy::World room(int scans, int with) {
  toy::Scanner scanner;
  scanner.azimuth_from = -20;
  scanner.azimuth_to = 20;
  toy::World world{scanner};
  Pose pose = Pose::Identity();
  pose.translation() << 0.013, 0.017, 0.011;
  const toy::Box wall{{12.03, -30, -30}, {13, 30, 30}}, box{{6.03, -0.6, -0.9}, {6.9, 0.6, 0.7}};
  for (int i = 0; i < scans; ++i) {
    world.scan(i < with ? std::vector{wall, box} : std::vector{wall}, pose);
  }
  return world;
}

Parameters free_after(int to_free) {
  Parameters parameters;
  parameters.counts_to_free = to_free;
  return parameters;
}

double removed_share(const toy::World& world, int owner, const Parameters& parameters) {
  const MaskStore masks = toy::masks_of(*make_freedom(parameters), world);
  return toy::removed_share(world, masks, owner, 0, world.size() - 1);
}

}  // namespace

TEST_CASE("freedom: what leaves goes once its place was seen free often enough") {
  CHECK(removed_share(room(5, 2), 1, free_after(3)) == 1.0);
  CHECK(removed_share(room(4, 2), 1, free_after(3)) == 0.0);  // Two scans only.
  CHECK(removed_share(room(8, 2), 1, Parameters{}) == 1.0);
  CHECK(removed_share(room(7, 2), 1, Parameters{}) == 0.0);
  CHECK(removed_share(room(8, 2), 0, Parameters{}) == 0.0);  // The wall stays.
}

TEST_CASE("freedom: what comes into free space goes in its own scan, till it has stayed") {
  toy::World world = room(3, 0);
  const toy::World after = room(24, 24);
  for (std::size_t i = 0; i < after.size(); ++i) {
    const Scan scan = after.load(i);
    world.add(scan.points, scan.T_world_sensor);
    world.owner.push_back(after.owner[i]);
  }
  Parameters parameters = free_after(3);
  // A static point of a later scan replaces those of higher levels.
  CHECK(removed_share(world, 1, parameters) == 0.0);
  parameters.counts_to_revert = 25;
  CHECK(removed_share(world, 1, parameters) == 1.0);
}

TEST_CASE("freedom: one scan, empty scans and points out of range remove nothing") {
  const toy::World one = room(1, 1);
  CHECK(toy::masks_of(*make_freedom(free_after(1)), one).removed_count() == 0);
  toy::HeldScans scans;
  for (int i = 0; i < 4; ++i) {
    scans.add({});
    scans.add({{1.0F, 0.0F, 0.0F}, {90.0F, 0.0F, 0.0F}, {3.0F, 0.0F, 25.0F}});
  }
  const MaskStore masks = toy::masks_of(*make_freedom(free_after(1)), scans);
  CHECK(masks.removed_count() == 0);
  CHECK(masks.get(0).empty());
}

TEST_CASE("freedom: points that are no numbers are an error and no answer") {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  toy::HeldScans scans;
  scans.add({{kNan, kNan, kNan}, {5.0F, kNan, 0.0F}});
  CHECK_THROWS_AS(toy::masks_of(*make_freedom({}), scans), DataError);
}

TEST_CASE("freedom: parameters that leave nothing to do are refused") {
  Parameters parameters;
  parameters.minimum_range = 80.0;
  CHECK_THROWS_AS(make_freedom(parameters), ConfigurationError);
}

}  // namespace raymoval::freedom_test
