// SPDX-License-Identifier: MIT
#include "methods/common/patchwork/ground_segmentation.h"

#include <catch2/catch.hpp>
#include <limits>
#include <numeric>

#include "tests/methods/moved_world.h"
#include "tests/methods/patchwork/level_ground.h"

namespace raymoval::patchwork_test {
using namespace raymoval::patchwork;

namespace {

int count(const Mask& mask) {
  return std::accumulate(mask.begin(), mask.end(), 0);
}

/// Ground whose sectors lie in turn at -1.70 and -1.72 and are rough by 2 and 3 cm.
Piece usual(int sector) {
  return {sector % 2 == 0 ? -1.70 : -1.72, sector % 4 < 2 ? 0.02 : 0.03};
}

}  // namespace

TEST_CASE("patchwork: level ground all around is ground, and what stands on it is not") {
  Scan scan = ring_scan([](int) { return Piece{}; });
  scan.points.emplace_back(5.0F, 0.1F, -1.0F);
  scan.points.emplace_back(2.0F, 0.1F, -1.7F);   // Nearer than the search for ground.
  scan.points.emplace_back(81.0F, 0.1F, -1.7F);  // Farther.
  scan.points.emplace_back(30.0F, 0.1F, -1.7F);  // Alone in its bin.
  scan.points.emplace_back(0.0F, 0.0F, 0.0F);
  const Mask mask = GroundSegmentation({}).find_ground(scan, 1);
  CHECK(count(mask) == 1600);
  CHECK(std::accumulate(mask.begin(), mask.begin() + 1600, 0) == 1600);
  CHECK(count(GroundSegmentation({}).find_ground(Scan{}, 1)) == 0);
}

TEST_CASE("patchwork: what is below the ground and reflects little is mirrored") {
  Scan scan = ring_scan([](int) { return Piece{}; });
  for (int i = 0; i < 6; ++i) {
    scan.points.emplace_back(4.9F + 0.1F * static_cast<float>(i % 3),
                             0.9F + 0.1F * static_cast<float>(i / 3), -2.6F);
  }
  // Without reflectance it counts as any other point below a plane.
  CHECK(count(GroundSegmentation({}).find_ground(scan, 1)) == 1606);
  scan.reflectance.assign(scan.size(), 0.1F);
  CHECK(count(GroundSegmentation({}).find_ground(scan, 1)) == 1600);
  scan.reflectance.assign(scan.size(), 0.2F);
  CHECK(count(GroundSegmentation({}).find_ground(scan, 1)) == 1606);
  // 0.8 m below the ground and no less: the ground is not mirrored, and neither is a ditch.
  scan.reflectance.assign(scan.size(), 0.1F);
  for (std::size_t i = 1600; i < 1606; ++i) scan.points[i].z() = -2.5F;
  CHECK(count(GroundSegmentation({}).find_ground(scan, 1)) == 1606);
}

TEST_CASE("patchwork: a narrow strip is no ground by being flat") {
  // Points along 4 m and across 0.2 m, rough by 3.15 cm: taken by TGR, were it not for its shape.
  GroundSegmentation segmentation({});
  segmentation.find_ground(ring_scan(usual), 1);
  Scan scan = ring_scan(usual);
  std::size_t next = 500;
  for (int i = 0; i < 10; ++i) {
    for (int k = 0; k < 10; ++k) {
      const double radius = 3.0 + 0.4 * i, azimuth = 5.5 / 16.0 * kTurn;
      const Eigen::Vector2d along(std::cos(azimuth), std::sin(azimuth));
      const Eigen::Vector2d at =
          radius * along + (0.02 * k - 0.09) * Eigen::Vector2d(-along.y(), along.x());
      const double z = -0.9 + ((i + k) % 2 == 0 ? 0.0315 : -0.0315);
      scan.points[next++] = Eigen::Vector3d(at.x(), at.y(), z).cast<float>();
    }
  }
  CHECK(ground_of(segmentation.find_ground(scan, 1), 5) == 0);
}

TEST_CASE("patchwork: the first scan tells the height of a sensor that is not said") {
  const auto low = [](int sector) { return Piece{sector == 3 ? -0.2 : -0.6, 0.01}; };
  GroundParameters parameters;
  parameters.public_height = false;
  GroundSegmentation told(parameters);
  Scan scan = ring_scan(low);
  for (int i = 0; i < 6; ++i) {
    scan.points.emplace_back(4.9F + 0.1F * static_cast<float>(i % 3), 0.9F, -2.0F);
  }
  scan.reflectance.assign(scan.size(), 0.1F);
  // 1.4 m below ground at 0.6 m is mirrored. To the published sensor, whose ground is 1.723 m
  // below, it is where the ground of its sector begins.
  CHECK(count(told.find_ground(scan, 1)) == 1600);
  CHECK(count(GroundSegmentation({}).find_ground(scan, 1)) == 1506);
  CHECK(told.thresholds().sensor_height() == Approx((15 * 0.6 + 0.2) / 16).margin(1e-6));
  // A scan without ground around the sensor says nothing, and waits for the next one.
  GroundSegmentation late(parameters);
  CHECK(count(late.find_ground(Scan{}, 1)) == 0);
  CHECK(late.thresholds().sensor_height() == std::numeric_limits<double>::infinity());
  CHECK(count(late.find_ground(scan, 1)) == 1600);
}

TEST_CASE("patchwork: a tilted sensor and a turned world see the same ground") {
  const toy::World street = toy::street(3);
  GroundParameters parameters;
  parameters.public_axes = false;
  GroundSegmentation level(parameters), leaning(parameters), turned(parameters),
      threaded(parameters);
  const Pose tilt(Eigen::AngleAxisd(0.5, Eigen::Vector3d(0.6, 0.8, 0.0)));
  std::size_t ground = 0, different = 0;
  for (std::size_t i = 0; i < street.size(); ++i) {
    const Scan scan = street.load(i);
    const Mask expected = level.find_ground(scan, 1);
    ground += static_cast<std::size_t>(count(expected));
    CHECK(threaded.find_ground(scan, 3) == expected);
    Scan other = scan;
    other.T_world_sensor = toy::whole_motion(0, 0, 0, 3) * scan.T_world_sensor;
    CHECK(turned.find_ground(other, 1) == expected);
    other.T_world_sensor = scan.T_world_sensor * tilt.inverse();
    for (Eigen::Vector3f& point : other.points) point = (tilt * point.cast<double>()).cast<float>();
    const Mask found = leaning.find_ground(other, 1);
    // Rounding to single precision, and sectors that begin elsewhere, may decide for single points.
    for (std::size_t k = 0; k < found.size(); ++k) different += found[k] != expected[k] ? 1 : 0;
  }
  CHECK(ground > 5000);
  CHECK(different < ground / 50);
}

}  // namespace raymoval::patchwork_test
