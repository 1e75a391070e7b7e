// SPDX-License-Identifier: MIT
#include "datasets/world_axes/up_direction.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "core/scan/local_frame.h"
#include "tests/datasets/flat_world.h"
#include "tests/datasets/inspect_data.h"

using namespace raymoval;
using namespace raymoval::test;
using Eigen::Vector3d;

namespace {

enum class Houses { kNone, kRows, kBlocks };

/// A straight road along x that climbs by `percent`, and a car on it: its sensor is 1.8 m above the
/// road and leans with it. Houses are upright: one wall on either side, or blocks with gables.
FlatWorld road(double percent, Houses houses) {
  const double climb = percent / 100.0;
  const Vector3d ahead = Vector3d(1, 0, climb).normalized();
  std::vector<Rectangle> surfaces = {{Vector3d::Zero(), 80.0 * ahead, {0, 40, 0}}};
  if (houses == Houses::kRows) {
    for (const double y : {-9.0, 8.0}) surfaces.push_back({{0, y, 0}, {70, 0, 0}, {0, 0, 30}});
  }
  for (double x = -30.0; houses == Houses::kBlocks && x < 40.0; x += 18.0) {
    for (const double side : {-1.0, 1.0}) {
      const Vector3d corner(x, 9.0 * side, climb * x);
      surfaces.push_back({corner + Vector3d(5, 0, 0), {5, 0, 0}, {0, 0, 7}});
      surfaces.push_back({corner + Vector3d(0, 5 * side, 0), {0, 5, 0}, {0, 0, 7}});
      surfaces.push_back({corner + Vector3d(10, 5 * side, 0), {0, 5, 0}, {0, 0, 7}});
    }
  }
  FlatWorld world;
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(-std::atan(climb), Vector3d::UnitY()).toRotationMatrix();
  for (int i = 0; i < 6; ++i) {
    pose.translation() = ahead * (2.3 * i - 6.0) + 1.8 * pose.linear().col(2);
    world.scan(surfaces, pose);
  }
  return world;
}

Pose turned(double degrees, const Vector3d& axis) {
  return Pose(Eigen::AngleAxisd(degrees * kDegree, axis.normalized()));
}

double degrees_between(const Vector3d& a, const Vector3d& b) {
  return std::acos(std::clamp(a.dot(b), -1.0, 1.0)) / kDegree;
}

Vector3d up_of(const ScanSource& scans) {
  return estimate_gravity(scans).up.direction;
}

}  // namespace

TEST_CASE("a slope is not mistaken for a tilted world", "[gravity][slow]") {
  for (const double percent : {0.0, 6.0, 18.0, 30.0, 50.0}) {
    for (const Houses houses : {Houses::kNone, Houses::kRows, Houses::kBlocks}) {
      INFO(percent << " %, houses " << static_cast<int>(houses));
      const GravityEvidence evidence = estimate_gravity(road(percent, houses));
      // The ground is found, and up is still the world's z.
      CHECK(degrees_between(evidence.ground, Vector3d::UnitZ()) ==
            Approx(std::atan(percent / 100.0) / kDegree).margin(1.0));
      CHECK(evidence.up.is_world_z());
      CHECK(evidence.up.source == UpDirection::Source::kWorldZ);
    }
  }
}

TEST_CASE("houses say how a world is tilted, on the level and on a slope", "[gravity][slow]") {
  for (const double percent : {0.0, 12.0}) {
    const FlatWorld upright = road(percent, Houses::kBlocks);
    for (const double degrees : {12.0, 20.0, 35.0, 60.0, 130.0}) {
      for (const Vector3d& axis : {Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(1, -2, 0.5)}) {
        INFO(percent << " %, turned by " << degrees << " about " << axis.transpose());
        const Pose turn = turned(degrees, axis);
        const GravityEvidence evidence = estimate_gravity(LocalFrameSource(upright, turn));
        CHECK(degrees_between(evidence.up.direction, turn.linear().col(2)) < 2.0);
        CHECK(evidence.up.source == UpDirection::Source::kEstimated);
      }
    }
  }
}

TEST_CASE("a tilt of a few degrees is left alone", "[gravity]") {
  const FlatWorld upright = road(0.0, Houses::kBlocks);
  CHECK(estimate_gravity(LocalFrameSource(upright, turned(5.0, {1, 0, 0}))).up.is_world_z());
}

TEST_CASE("walls that all face one way do not say how far up leans along them", "[gravity]") {
  const FlatWorld street = road(0.0, Houses::kRows);
  // About the road the walls lean with the world; about their normal they stay upright, and a road
  // that climbs by a third looks the same.
  const Pose roll = turned(20.0, Vector3d::UnitX());
  CHECK(degrees_between(up_of(LocalFrameSource(street, roll)), roll.linear().col(2)) < 2.0);
  CHECK(estimate_gravity(LocalFrameSource(street, turned(18.0, {0, 1, 0}))).up.is_world_z());
}

TEST_CASE("each axis of the world may be up, exactly", "[gravity]") {
  for (const Houses houses : {Houses::kNone, Houses::kBlocks}) {
    const FlatWorld upright = road(0.0, houses);
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {1.0, -1.0}) {
        const Vector3d up = Vector3d::Unit(axis) * sign;
        Pose turn = Pose::Identity();
        turn.linear() = turn_to_z(up).transpose();
        INFO("up is " << axis_text(up));
        CHECK(up_of(LocalFrameSource(upright, turn)) == up);
      }
    }
  }
}

TEST_CASE("a simulated drive is upright in any world", "[gravity]") {
  const test::EditedSequence drive = test::good_drive();
  CHECK(estimate_gravity(drive).up.is_world_z());
  for (const double degrees : {20.0, 30.0, 90.0, 180.0}) {
    INFO("turned by " << degrees);
    const Pose turn = turned(degrees, Vector3d(1, 0, 0));
    CHECK(degrees_between(up_of(LocalFrameSource(drive, turn)), turn.linear().col(2)) < 2.0);
  }
}

namespace {

/// Scans along a loop through `surfaces`, by a sensor that is turned by `mount`.
FlatWorld loop_through(const std::vector<Rectangle>& surfaces, double height,
                       const Eigen::Matrix3d& mount) {
  FlatWorld world;
  for (int i = 0; i < 8; ++i) {
    const double angle = 45.0 * kDegree * i;
    Pose pose(Eigen::Translation3d(6.0 * std::cos(angle), 4.0 * std::sin(angle), height));
    pose.linear() = Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix() * mount;
    world.scan(surfaces, pose);
  }
  return world;
}

}  // namespace

TEST_CASE("z stays up for a drone beside facades, however its sensor is turned", "[gravity]") {
  // Facades on either side, 8 m away, look like ground; the street is 25 m below.
  const std::vector<Rectangle> street = {{{0, 0, 0}, {150, 0, 0}, {0, 60, 0}},
                                         {{0, 8, 20}, {70, 0, 0}, {0, 0, 20}},
                                         {{0, -8, 20}, {70, 0, 0}, {0, 0, 20}}};
  for (const Vector3d& axis : {Vector3d(1, 0, 0), Vector3d(0, 1, 0)}) {
    for (const double degrees : {60.0, 90.0, 180.0}) {
      FlatWorld flight;
      for (int i = 0; i < 6; ++i) {
        flight.scan(street, Eigen::Translation3d(3.0 * i, 0, 25) * turned(degrees, axis));
      }
      INFO("turned by " << degrees << " about " << axis.transpose());
      CHECK(estimate_gravity(flight).up.is_world_z());
    }
  }
}

TEST_CASE("z stays up for a sensor that hangs from a ceiling or lies on its side", "[gravity]") {
  for (const double degrees : {90.0, 180.0}) {
    const Eigen::Matrix3d mount = turned(degrees, Vector3d::UnitX()).linear();
    CHECK(estimate_gravity(loop_through(hall(), 3.6, mount)).up.is_world_z());
    CHECK(estimate_gravity(loop_through(hall(), 1.0, mount)).up.is_world_z());
  }
}

TEST_CASE("what a user states is contradicted by several kinds of evidence only", "[gravity]") {
  const FlatWorld upright = loop_through(hall(), 1.2, Eigen::Matrix3d::Identity());
  const Vector3d down_y(0, -1, 0);
  // The floor is missing if -y were up, and the path lies across z.
  CHECK(estimate_gravity(upright, down_y).up.direction == Vector3d::UnitZ());
  // In camera axes -y is up, and nothing speaks against it.
  Pose camera = Pose::Identity();
  camera.linear() = turn_to_z(down_y).transpose();
  const LocalFrameSource turned_world(upright, camera);
  CHECK(estimate_gravity(turned_world, down_y).up.direction == down_y);
  CHECK(estimate_gravity(turned_world).up.direction == down_y);
}
