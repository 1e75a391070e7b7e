// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <optional>

#include "tests/simulated/scenes.h"

using namespace raymoval;
using namespace raymoval::simulated;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

constexpr Paint kPaint{Material::kPerfect, kLabelBuilding};
using ClosedForm = std::function<std::optional<double>(const Vector3d& from, const Vector3d& to)>;

/// Sweep `scan` of the plain sensor, without noise, from a fixed pose.
Sweep sweep_from(const World& world, const Isometry3d& pose, std::size_t scan = 0,
                 Rolling rolling = Rolling::kNone) {
  const SensorFile sensor = plain_sensor();
  return Scanner(
             world, sensor, [&](double) { return pose; }, {1, rolling, true}, 1)
      .sweep(scan);
}

/// Shoots every direction of the plain sensor at the world and compares with the closed form, which
/// says at what distance a ray hits, or that it does not. Returns how many hits were compared.
std::size_t compare(const World& world, const Isometry3d& pose, const ClosedForm& truth) {
  const Sweep sweep = sweep_from(world, pose);
  std::size_t next = 0;
  std::size_t compared = 0;
  double worst = 0.0;
  for (const Shot& shot : plain_sensor().shots(0, 1)) {
    const Vector3d direction = pose.linear() * shot.direction;
    const auto range = truth(pose.translation(), direction);
    const bool here = next < sweep.points.size() &&
                      sweep.points[next].cast<double>().normalized().dot(shot.direction) > 1 - 1e-9;
    const double found = here ? sweep.points[next].cast<double>().norm() : -1.0;
    if (here) ++next;
    if (!range || *range > 190.0) continue;
    REQUIRE(here);
    worst = std::max(worst, std::abs(found - *range));
    ++compared;
  }
  CHECK(next == sweep.points.size());
  CHECK(worst < 1e-3);
  return compared;
}

/// Distance to an axis-aligned box, by slabs.
std::optional<double> box_range(const Vector3d& low, const Vector3d& high, const Vector3d& from,
                                const Vector3d& to) {
  double enter = 0.0;
  double leave = 1e300;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (low[axis] - from[axis]) / to[axis];
    const double b = (high[axis] - from[axis]) / to[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (enter > leave) return std::nullopt;
  return enter;
}

/// Nearest positive root of the distance to a ball or, with `flat`, an endless upright cylinder.
std::optional<double> round_range(Vector3d from, Vector3d to, double radius, bool flat) {
  if (flat) from.z() = to.z() = 0.0;
  const double a = to.squaredNorm();
  const double b = from.dot(to);
  const double inside = b * b - a * (from.squaredNorm() - radius * radius);
  if (inside < 0.0) return std::nullopt;
  return (-b - std::sqrt(inside)) / a;
}

}  // namespace

TEST_CASE("a box is met where the slabs of its sides say") {
  World world;
  Mesh mesh;
  const Vector3d low(-2, -3, -4);
  const Vector3d high(2, 3, 4);
  add_box(mesh, kPaint, low, high);
  const Vector3d centre(2012.0, 3005.0, 1.0);
  world.add_static(mesh, placed(centre.x(), centre.y(), centre.z()));
  world.finish();
  const Isometry3d pose = tilted({2001.0, 3002.0, 1.2}, -0.2, 0.1, 0.05);
  const std::size_t count = compare(world, pose, [&](const Vector3d& from, const Vector3d& to) {
    return box_range(centre + low, centre + high, from, to);
  });
  CHECK(count > 500);
}

TEST_CASE("a sphere is met at the root of its quadratic") {
  // Facets lie at most R (1 - cos(pi / 400)) = 0.06 mm inside the sphere; rays that meet it steeper
  // than 17 degrees (cosine 0.3) see at most 0.2 mm of that.
  World world;
  Mesh mesh;
  add_ellipsoid(mesh, kPaint, Vector3d::Zero(), Vector3d::Constant(2.0), 400, 800);
  world.add_static(mesh, placed(906.0, 0.5, 0.3));
  world.finish();
  const Vector3d centre(906.0, 0.5, 0.3);
  const SensorFile sensor = plain_sensor();
  const Isometry3d pose = tilted({900.0, 0.0, 0.0}, 0.0, 0.05, 0.3);
  const Scanner scanner(
      world, sensor, [&](double) { return pose; }, {1, Rolling::kNone, true}, 1);
  std::size_t count = 0;
  for (const Eigen::Vector3f& point : scanner.sweep(0).points) {
    const Vector3d to = pose.linear() * point.cast<double>().normalized();
    const auto range = round_range(pose.translation() - centre, to, 2.0, false);
    if (!range) continue;
    const Vector3d hit = pose.translation() + *range * to - centre;
    if (hit.normalized().dot(to) > -0.3) continue;
    CHECK(std::abs(point.cast<double>().norm() - *range) < 1e-3);
    ++count;
  }
  CHECK(count > 300);
}

TEST_CASE("a moving box is where its speed has brought it") {
  // The box starts with its middle at x = 30 m and moves 8 m/s; at scan 15 (1.5 s) its back is at
  // 30 + 12 - 1 = 41 m. For a sensor at x = 20 m, 1 m high, the back is 21 m ahead.
  const Ground ground = flat_ground();
  World world;
  world.add_mover(box_mover(ground, 30.0, 8.0));
  world.finish();
  const Isometry3d pose(Eigen::Translation3d(20.0, 0.0, 1.0));
  const Sweep sweep = sweep_from(world, pose, 15);
  REQUIRE(sweep.points.size() > 10);
  for (const Eigen::Vector3f& point : sweep.points) {
    const auto range =
        box_range({21, -1, -1}, {23, 1, 1}, Vector3d::Zero(), point.cast<double>().normalized());
    REQUIRE(range);
    CHECK(std::abs(point.cast<double>().norm() - *range) < 1e-3);
  }
}

TEST_CASE("a rolling scan is skewed by the motion of the sensor, or corrected for it") {
  // The sensor drives 10 m/s towards a wall 50 m ahead. Straight ahead is taken at the reference
  // time; azimuth a is taken a / 2 pi of the period earlier (the head turns clockwise), when the
  // wall was 10 m/s * 0.1 s * a / 2 pi farther.
  World world;
  Mesh mesh;
  add_quad(mesh, kPaint, {0, -90, -90}, {0, 90, -90}, {0, 90, 90}, {0, -90, 90});
  world.add_static(mesh, placed(50, 0, 0));
  world.finish();
  const SensorFile sensor = plain_sensor();
  const auto pose = [](double time) {
    return Isometry3d(Eigen::Translation3d(10.0 * time, 0.0, 0.0));
  };
  const Scanner skewed(world, sensor, pose, {1, Rolling::kSkewed, true}, 1);
  const Scanner corrected(world, sensor, pose, {1, Rolling::kCorrected, true}, 1);
  const Sweep as_taken = skewed.sweep(0);
  const Sweep as_one = corrected.sweep(0);
  REQUIRE(as_taken.points.size() > 2000);
  REQUIRE(as_taken.points.size() == as_one.points.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < as_taken.points.size(); ++i) {
    const Eigen::Vector3d p = as_taken.points[i].cast<double>();
    const double expected = 50.0 + 1.0 * std::atan2(p.y(), p.x()) / (2.0 * 3.14159265358979);
    CHECK(std::abs(p.x() - expected) < 1e-3);
    CHECK(std::abs(as_one.points[i].x() - 50.0F) < 1e-3F);
    largest = std::max(largest, std::abs(p.x() - 50.0));
  }
  CHECK(largest > 0.1);
}

TEST_CASE("a box that moves during a rolling scan is met where it then is") {
  // The sensor is stationary; the box's back is 19 m ahead at the reference time and moves 20 m/s.
  // Only azimuths within about 3 degrees hit it, so it is there to within
  // 20 * 0.1 * 3 / 360 = 0.017 m.
  const Ground ground = flat_ground();
  World world;
  world.add_mover(box_mover(ground, 20.0, 20.0));
  world.finish();
  const Isometry3d pose(Eigen::Translation3d(0.0, 0.0, 1.0));
  const Sweep sweep = sweep_from(world, pose, 0, Rolling::kSkewed);
  REQUIRE(sweep.points.size() > 10);
  bool slanted = false;
  for (const Eigen::Vector3f& point : sweep.points) {
    const double turn = std::atan2(point.y(), point.x()) / (2.0 * 3.14159265358979);
    CHECK(std::abs(point.x() - (19.0 - 20.0 * 0.1 * turn)) < 1e-3);
    slanted = slanted || std::abs(turn) > 0.005;
  }
  CHECK(slanted);
}
