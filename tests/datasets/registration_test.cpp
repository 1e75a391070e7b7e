// SPDX-License-Identifier: MIT
// Registration of overlapping scans, the fit of poses, and the origin of rays, on the exact street:
// ground, two walls, two poles and a parked car, with an ideal sensor that moves 1 m per scan.
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <utility>
#include <vector>

#include "core/angle.h"
#include "datasets/registration/pose_fit.h"
#include "datasets/registration/ray_origin.h"
#include "datasets/registration/register_scans.h"
#include "datasets/simulation/street/street.h"
#include "tests/datasets/wrong_poses.h"

namespace raymoval::registration {
using test::wrong_poses;

namespace {

Scan street_scan(std::size_t index) {
  return make_street({}, street_boxes()).scans->load(index);
}

}  // namespace

TEST_CASE("registration finds the motion between two scans from a guess that is off",
          "[registration]") {
  const Scan first = street_scan(10), second = street_scan(12);
  const Pose truth = first.T_world_sensor.inverse() * second.T_world_sensor;
  const SurfaceCloud from(first), to(second);
  // Off by 0.3 m to the side, 0.2 m in height and 2 degrees about z. Along the walls little is
  // seen.
  Pose guess = truth;
  guess.pretranslate(Eigen::Vector3d(0.0, 0.3, 0.2));
  guess.rotate(Eigen::AngleAxisd(2.0 * kDegree, Eigen::Vector3d::UnitZ()));
  const Registration found = register_scans(from, to, guess);
  const Eigen::Vector3d off = found.T_from_to.translation() - truth.translation();
  CHECK(std::abs(off.y()) < 0.005);
  CHECK(std::abs(off.z()) < 0.005);
  CHECK(Eigen::AngleAxisd(found.T_from_to.linear().transpose() * truth.linear()).angle() <
        0.1 * kDegree);
  CHECK(found.noise < 0.005);
  // Walls move by 0.3 m or the ground by 0.2 m, and the turn adds to the former.
  CHECK(found.shift > 0.2);
  CHECK(found.shift < 0.6);

  const Registration right = register_scans(from, to, truth);
  CHECK(right.shift < 0.002);
  CHECK(right.overlap > 0.6);
}

TEST_CASE("a motion that no surface determines stays as guessed", "[registration]") {
  // Two walls and the ground do not constrain the motion of the sensor along them.
  std::vector<StreetBox> walls = street_boxes();
  std::erase_if(walls, [](const StreetBox& box) { return box.label != 50; });
  const Sequence street = make_street({}, walls);
  const Scan first = street.scans->load(20), second = street.scans->load(21);
  Pose guess = first.T_world_sensor.inverse() * second.T_world_sensor;
  guess.translation().x() += 0.2;
  const Registration found = register_scans(SurfaceCloud(first), SurfaceCloud(second), guess);
  CHECK(found.T_from_to.translation().x() == Approx(guess.translation().x()).margin(0.02));
  CHECK(found.shift < 0.01);
}

TEST_CASE("surfaces do not depend on the order of points", "[registration]") {
  Scan scan = street_scan(5);
  const SurfaceCloud before(scan);
  std::shuffle(scan.points.begin(), scan.points.end(), std::mt19937(7));
  const SurfaceCloud after(scan);
  REQUIRE(before.points().size() == after.points().size());
  REQUIRE(before.points().size() > 500);
  for (std::size_t i = 0; i < before.points().size(); ++i) {
    REQUIRE(before.points()[i].position == after.points()[i].position);
    REQUIRE(before.points()[i].normal == after.points()[i].normal);
  }
}

TEST_CASE("only pairs across a jump of the poses do not fit", "[registration]") {
  const auto poses = wrong_poses([](std::size_t i) -> Eigen::Vector3d {
    return {0.0, i < 25 ? 0.0 : 0.4, 0.0};
  });
  const PoseFit jump = measure_pose_fit(poses, 1);
  REQUIRE(jump.pairs.size() > 20);
  CHECK(jump.distance_m < 0.05);
  CHECK(worst_pair(jump).distance_m > 0.1);
  for (const PairDistance& pair : jump.pairs) {
    const bool across = pair.from < 25 && pair.to >= 25;
    CHECK((across || pair.distance_m < 0.01));
  }
  // The answer does not depend on the number of threads.
  const PoseFit again = measure_pose_fit(poses, 8);
  REQUIRE(again.pairs.size() == jump.pairs.size());
  CHECK(again.distance_m == jump.distance_m);
}

namespace {

/// The street twice: even scans, then odd scans with an error of the poses in plan.
toy::HeldScans two_passes(const Eigen::Vector3d& error) {
  const auto street = make_street({}, street_boxes()).scans;
  toy::HeldScans passes(street->sensor());
  for (std::size_t i = 0; i < street->size(); i += 2) passes.add_scan(street->load(i));
  for (std::size_t i = 1; i < street->size(); i += 2) {
    Scan scan = street->load(i);
    scan.T_world_sensor.translation() += error;
    passes.add_scan(std::move(scan));
  }
  return passes;
}

}  // namespace

TEST_CASE("an error in plan of up to 3 m on a return to a place is found", "[registration]") {
  CHECK(fits(measure_pose_fit(two_passes({0.0, 0.0, 0.0}), 2)));
  for (const double error : {0.3, 1.0, 2.0, 3.0}) {
    CAPTURE(error);
    const PoseFit side = measure_pose_fit(two_passes({0.0, error, 0.0}), 2);
    CHECK(std::any_of(side.pairs.begin(), side.pairs.end(), [](const PairDistance& pair) {
      return pair.is_return && pair.distance_m > kMostDistanceOfPair;
    }));
  }
}

TEST_CASE("poses that are wrong between two stations do not fit", "[registration]") {
  const auto between = [](std::size_t i) -> Eigen::Vector3d {
    return {0.0, i > 1 && i < 7 ? 0.5 : 0.0, 0.0};
  };
  CHECK(worst_pair(measure_pose_fit(wrong_poses(between), 2)).distance_m > kMostDistanceOfPair);
}

TEST_CASE("less than two scans, and scans without points, fit without a pair", "[registration]") {
  const auto street = wrong_poses([](std::size_t) { return Eigen::Vector3d::Zero(); });
  Scan empty = street.load(0);
  empty.points.clear();
  const SurfaceCloud nothing(empty);
  CHECK(nothing.points().empty());
  CHECK(nothing.nearest(Eigen::Vector3f::Zero(), 1.0F) == nullptr);
  const Registration found = register_scans(nothing, nothing, Pose::Identity());
  CHECK(found.matched == 0);
  CHECK(found.shift == 0.0);
}

TEST_CASE("scan lines show where the rays start", "[registration]") {
  std::vector<Scan> scans = {street_scan(5), street_scan(25), street_scan(45)};
  const RayOrigin given = find_ray_origin(scans);
  CHECK(given.origin.norm() < 0.15);

  // The frame of a vehicle: the sensor is 0.8 m ahead of its origin, and 1.7 m above it.
  const Eigen::Vector3f sensor(0.8F, 0.3F, 1.7F);
  for (Scan& scan : scans) {
    for (Eigen::Vector3f& point : scan.points) point += sensor;
  }
  const RayOrigin found = find_ray_origin(scans);
  CHECK((found.origin - sensor.cast<double>()).norm() < 0.15);
  CHECK(found.misfit_found < found.misfit_given - 0.1);
}

}  // namespace raymoval::registration
