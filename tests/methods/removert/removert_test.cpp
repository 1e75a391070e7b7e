// SPDX-License-Identifier: MIT
#include "methods/removert/removert.h"

#include <catch2/catch.hpp>
#include <numbers>

#include "tests/methods/moved_world.h"
#include "tests/methods/removert/point_world.h"

namespace raymoval::removert_test {
using namespace raymoval::removert_method;

namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

std::string verdicts_with(const Settings& settings, const ScanSource& scans) {
  return verdicts(removert("rm3", settings), scans);
}

// A car's front and the plate behind it, then the wall that they hid, all in one pixel.
const PointWorld kTwoLayers({{ahead(10), ahead(11)}, {ahead(20)}});

}  // namespace

TEST_CASE("removert: each pass takes one layer off, once the map is updated") {
  CHECK(verdicts_with(passes({2.5}), kTwoLayers) == "10 0");
  CHECK(verdicts_with(passes({2.5, 2.2}), kTwoLayers) == "11 0");
  CHECK(verdicts_with(passes({2.5, 2.2, 2.0}), kTwoLayers) == "11 0");
  CHECK(verdicts_with(Settings{{"update_between_passes", "false"}}, kTwoLayers) == "10 0");
}

TEST_CASE("removert: the absolute difference loses the wall once the car is gone") {
  // Pass 1 takes the car away; in pass 2 the first scan has its return at 10 m and the map begins
  // at 20 m.
  const PointWorld world({{ahead(10)}, {ahead(20)}});
  CHECK(verdicts_with({}, world) == "1 0");
  CHECK(verdicts_with({{"difference", "absolute"}}, world) == "1 1");
}

TEST_CASE("removert: a car that never leaves is never removed") {
  const PointWorld world({{ahead(10)}, {ahead(10)}, {ahead(10)}});
  CHECK(verdicts_with({}, world) == "0 0 0");
}

TEST_CASE("removert: revert brings back ground that was removed at a grazing angle") {
  // Pixels of 0.4 degrees: E shares its row (75) with P1, 1.5 m behind it, and not with P2 (76).
  // Pixels of 1 degree: all three are in row 30, whose nearest return is at 18.6 m.
  const PointWorld world({{polar(20.0, -5.0), polar(18.6, -5.45)}, {polar(18.5, -5.05)}});
  CHECK(verdicts_with(passes({2.5}), world) == "00 1");
  CHECK(verdicts_with(passes({2.5}, 1.0), world) == "00 0");
  CHECK(verdicts_with(passes({2.5}, 2.375), world) == "00 0");
}

TEST_CASE("removert: revert also brings back what other removed points hide") {
  const PointWorld world({{ahead(9.9), ahead(10)}, {ahead(20)}});
  CHECK(verdicts_with(passes({2.5, 2.2}), world) == "11 0");
  CHECK(verdicts_with(passes({2.5, 2.2}, 1.0), world) == "10 0");
}

TEST_CASE("removert: rm3-rv1 is rm3 with a revert pass of 0.55 degrees") {
  const auto method = removert("rm3-rv1");
  CHECK(verdicts(method, kTwoLayers) == verdicts_with(passes({2.5, 2.2, 2.0}, 1.8182), kTwoLayers));
  CHECK(verdicts(method, kTwoLayers) == "10 0");
}

TEST_CASE("removert: poses are used in full") {
  // The second scan is taken from (2, 1, 0.5), turned by 90 degrees about z and then pitched; it
  // sees a wall 20 m ahead, past the point that the first scan saw on that line.
  Pose pose = Pose::Identity();
  pose.linear() = (Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()))
                      .matrix();
  pose.translation() << 2.0, 1.0, 0.5;
  const Eigen::Vector3f before = (pose * ahead(12).cast<double>()).cast<float>();
  PointWorld world({{before}});
  world.add({ahead(20)}, pose);
  CHECK(verdicts_with({}, world) == "1 0");
}

TEST_CASE("removert: nothing in, nothing out") {
  for (const char* variant : {"rm3", "rm3-rv1", "code", "port"}) {
    INFO(variant);
    CHECK(verdicts(removert(variant), PointWorld({{{1, 2, 3}}, {}})) == "0 ");
  }
}

TEST_CASE("removert: on a street the movers go, the wall stays, and revert mends the road",
          "[slow]") {
  const World world = street(16);
  const MaskStore removed = masks_of(*removert("rm3").make(), world);
  const MaskStore reverted = masks_of(*removert("rm3-rv1").make(), world);
  const auto share = [&](const MaskStore& masks, int owner) {
    return removed_share(world, masks, owner, 0, 15);
  };
  constexpr int kRoad = 0, kWall = 1, kCar = 3, kPerson = 4;
  // Measured: person 98 %, car 71 %, wall 0.1 %, road 30 %. The car's far layers outnumber the
  // passes; beyond 12 m a pixel of 0.4 degrees holds more road than the margin's 5 %.
  CHECK(share(removed, kPerson) > 0.9);
  CHECK(share(removed, kCar) > 0.6);
  CHECK(share(removed, kWall) < 0.01);
  // Measured: road 14 %, car 44 %. Revert also brings back what lay in the removed car's second
  // layer.
  CHECK(share(reverted, kRoad) < 0.7 * share(removed, kRoad));
  CHECK(share(reverted, kCar) < share(removed, kCar));
}

}  // namespace raymoval::removert_test
