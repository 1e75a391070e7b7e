// SPDX-License-Identifier: MIT
// Poses from scans: maps of planes, odometry, pose graphs, loops, and refined poses. Worlds are a
// room of 16 x 12 m with a pillar, seen without noise, and the exact street.
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "core/angle.h"
#include "core/error.h"
#include "core/scan/local_frame.h"
#include "datasets/odometry/estimate.h"
#include "datasets/odometry/odometry.h"
#include "datasets/registration/reposed_source.h"
#include "tests/datasets/flat_world.h"

namespace raymoval::odometry {
using Eigen::Vector3d;
using test::FlatWorld;
using test::Rectangle;

namespace {

/// Floor, four walls, and two faces of a pillar beside the middle.
std::vector<Rectangle> room(const Vector3d& at = Vector3d::Zero()) {
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  std::vector<Rectangle> surfaces = {{{0, 0, -1.5}, 8 * x, 6 * y}, {{8, 0, 1}, 6 * y, 2.5 * z},
                                     {{-8, 0, 1}, 6 * y, 2.5 * z}, {{0, 6, 1}, 8 * x, 2.5 * z},
                                     {{0, -6, 1}, 8 * x, 2.5 * z}, {{2, 3, 1}, 0.8 * y, 2.5 * z},
                                     {{3, 2.2, 1}, x, 2.5 * z}};
  for (Rectangle& surface : surfaces) surface.centre += at;
  return surfaces;
}

Pose pose_at(double x, double y, double yaw_deg) {
  Pose pose = Pose::Identity();
  pose.translation() = Vector3d(x, y, 0.0);
  pose.linear() = Eigen::AngleAxisd(yaw_deg * kDegree, Vector3d::UnitZ()).toRotationMatrix();
  return pose;
}

/// Scans along a circle of 2 m radius, twice, with a heading that sways by 10 degrees.
FlatWorld round_trip() {
  constexpr int kScans = 40;
  FlatWorld world;
  for (int i = 0; i < kScans; ++i) {
    const double angle = 4.0 * std::numbers::pi * i / kScans;
    world.scan(room(),
               pose_at(2.0 * std::cos(angle), 2.0 * std::sin(angle), 10.0 * std::sin(angle)));
  }
  return world;
}

/// Largest distance of poses from the truth, relative to the first pose, metres.
double error_of(const std::vector<Pose>& poses, const ScanSource& truth) {
  double most = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Vector3d found = (poses[0].inverse() * poses[i]).translation();
    const Vector3d wanted = (truth.pose(0).inverse() * truth.pose(i)).translation();
    most = std::max(most, (found - wanted).norm());
  }
  return most;
}

std::string all_notes(const PoseEstimate& estimate) {
  std::string text = estimate.summary + '\n';
  for (const std::string& warning : estimate.warnings) text += warning + '\n';
  return text;
}

}  // namespace

TEST_CASE("a cell has the plane of its points, and no plane if they fill it", "[odometry]") {
  std::vector<Eigen::Vector3f> wall, heap;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> any(0.0F, 0.5F);
  for (int i = 0; i < 60; ++i) {
    wall.emplace_back(0.2F, any(random), any(random));
    heap.emplace_back(5.0F + any(random), any(random), any(random));
  }
  PlaneMap map(0.5);
  map.add(wall);
  map.add(heap);
  // A point 3 cm behind the wall is 3 cm from its plane.
  const auto beside = map.match({{0.23F, 0.2F, 0.2F}}, Pose::Identity(), 0.1);
  REQUIRE(beside.size() == 1);
  CHECK(std::abs(beside[0].distance) == Approx(0.03).margin(1e-4));
  CHECK(std::abs(beside[0].normal.x()) == Approx(1.0).margin(1e-4));
  // A point of the heap is matched with a point, along three axes.
  const auto heaped = map.match({heap[0]}, Pose::Identity(), 0.1);
  REQUIRE(heaped.size() == 3);
  for (const auto& match : heaped) CHECK(match.distance == Approx(0.0).margin(1e-6));
  CHECK(map.match({{9.0F, 9.0F, 9.0F}}, Pose::Identity(), 0.1).empty());
}

TEST_CASE("cells far away are forgotten", "[odometry]") {
  PlaneMap map(0.5);
  map.add({{0.1F, 0.1F, 0.1F}, {30.0F, 0.0F, 0.0F}});
  CHECK(map.size() == 2);
  map.forget_beyond(Vector3d::Zero(), 20.0);
  CHECK(map.size() == 1);
}

TEST_CASE("a pose graph spreads the error of a closed loop", "[odometry]") {
  // Four steps of 1 m ahead and a turn of 90 degrees end at the start. The steps are measured as
  // 1.04 m, and the loop as closed: each step then has a quarter of the rest.
  const Pose step = pose_at(1.0, 0.0, 90.0), measured = pose_at(1.04, 0.0, 90.0);
  std::vector<Pose> poses = {Pose::Identity()};
  std::vector<GraphEdge> edges;
  for (std::size_t i = 0; i < 3; ++i) {
    poses.push_back(poses.back() * measured);
    edges.push_back({i, i + 1, measured, {0.01, 0.001}});
  }
  edges.push_back({3, 0, step, {0.0001, 0.0001}});
  const std::vector<Pose> found = optimised(poses, edges);
  CHECK(found[0].isApprox(Pose::Identity(), 1e-6));
  CHECK((found[3].inverse() * found[0]).isApprox(step, 1e-3));
  // The two sides that cross the loop's are opposite and equally long.
  CHECK((found[1].translation() - found[0].translation()).norm() ==
        Approx((found[3].translation() - found[2].translation()).norm()).margin(0.03));
}

TEST_CASE("a wrong loop loses its weight, and a measured pose places the graph", "[odometry]") {
  std::vector<Pose> poses;
  std::vector<GraphEdge> edges;
  for (std::size_t i = 0; i < 5; ++i) {
    poses.push_back(pose_at(static_cast<double>(i), 0.0, 0.0));
    if (i > 0) edges.push_back({i - 1, i, pose_at(1.0, 0.0, 0.0), {0.01, 0.001}});
  }
  edges.push_back({0, 4, pose_at(1.0, 2.0, 40.0), {0.02, 0.001}, true});
  const std::vector<Pose> kept = optimised(poses, edges);
  CHECK((kept[4].translation() - Vector3d(4.0, 0.0, 0.0)).norm() < 0.05);

  edges.pop_back();
  edges.push_back({std::nullopt, 2, pose_at(2.0, 7.0, 0.0), {0.1, 0.01}});
  const std::vector<Pose> placed = optimised(poses, edges);
  CHECK((placed[0].translation() - Vector3d(0.0, 7.0, 0.0)).norm() < 1e-3);
  CHECK((placed[4].translation() - Vector3d(4.0, 7.0, 0.0)).norm() < 1e-3);
}

TEST_CASE("poses are estimated from the scans of a room, for any number of threads", "[odometry]") {
  const FlatWorld world = round_trip();
  const PoseEstimate one = estimate_poses({world});
  CHECK(error_of(one.poses, world) < 0.05);
  CHECK(one.poses[0].isApprox(Pose::Identity()));
  CHECK(one.loops > 0);
  MovingScans input{world};
  input.threads = 3;
  const PoseEstimate three = estimate_poses(input);
  REQUIRE(three.poses.size() == one.poses.size());
  for (std::size_t i = 0; i < one.poses.size(); ++i) {
    CHECK(three.poses[i].matrix() == one.poses[i].matrix());
  }
  CHECK(all_notes(three) == all_notes(one));
}

TEST_CASE("the estimate does not depend on the order of the points", "[odometry]") {
  FlatWorld world = round_trip();
  world.shuffle();
  CHECK(error_of(estimate_poses({world}).poses, world) < 0.05);
}

TEST_CASE("estimates do not depend on where surfaces lie, nor on the axes of the sensor",
          "[odometry]") {
  const Eigen::AngleAxisd turns[] = {Eigen::AngleAxisd(0.0, Vector3d::UnitZ()),
                                     Eigen::AngleAxisd(90.0 * kDegree, Vector3d::UnitZ()),
                                     Eigen::AngleAxisd(45.0 * kDegree, Vector3d::UnitX()),
                                     Eigen::AngleAxisd(70.0 * kDegree, Vector3d(3, -1, 2) / 3.742)};
  // From the first scan, all surfaces of the room are at multiples of 0.5 m, the size of cells.
  for (const Vector3d& shift : {Vector3d(0, 0, 0), Vector3d(0.25, 0.1, 0.2)}) {
    FlatWorld world;
    for (int i = 0; i < 10; ++i) world.scan(room(shift), pose_at(0.2 * i, 0.02 * i * i, 2.0 * i));
    for (const Eigen::AngleAxisd& turn : turns) {
      CAPTURE(shift.transpose(), turn.axis().transpose(), turn.angle());
      const toy::ChangedScans turned(
          world, [&](Scan& scan) { turn_sensor_frame(turn.toRotationMatrix(), scan); });
      MovingScans input{turned};
      input.scale = {5.0, 0.5};
      CHECK(error_of(estimate_poses(input).poses, turned) < 0.02);
    }
  }
}

TEST_CASE("a sensor at rest is reported, and does not drift", "[odometry]") {
  FlatWorld world;
  for (int i = 0; i < 8; ++i) world.scan(room(), pose_at(1.0, 0.5, 10.0));
  const PoseEstimate estimate = estimate_poses({world});
  CHECK(error_of(estimate.poses, world) < 0.002);
  CHECK(all_notes(estimate).find("The sensor was at rest") != std::string::npos);
}

namespace {

/// A road along x: ground and low barriers, which fit any motion along it, walls that face the road
/// beyond the left barrier, and vehicles that move with the sensor by 3 m a scan.
/// @param half_height of the walls, metres
FlatWorld motorway(double half_height) {
  constexpr int kScans = 14;
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  const double places[] = {-38, -31, -17, -11, 2, 9, 23, 28, 44, 57, 63, 76, 80, 97};
  FlatWorld world;
  for (int i = 0; i < kScans; ++i) {
    const double at = 3.0 * i;
    std::vector<Rectangle> surfaces = {{{at, 0, -1.7}, 60 * x, 20 * y}};
    for (const double side : {-1.0, 1.0}) {
      surfaces.push_back({{at, 9 * side, -1.4}, 60 * x, 0.3 * z});
      for (const double ahead : {-14.0, 8.0}) {
        surfaces.push_back({{at + ahead, 4 * side, -0.7}, y, z});
        surfaces.push_back({{at + ahead + 2.0, 3 * side, -0.7}, 2 * x, z});
      }
    }
    for (const double place : places) {
      surfaces.push_back({{place, 12, -1.7 + half_height}, 2 * y, half_height * z});
    }
    world.scan(surfaces, pose_at(at, 0, 0));
  }
  return world;
}

}  // namespace

TEST_CASE("vehicles at the speed of the sensor do not hide its motion", "[odometry]") {
  const FlatWorld world = motorway(4.0);
  const PoseEstimate estimate = estimate_poses({world});
  CAPTURE(all_notes(estimate));
  CHECK(error_of(estimate.poses, world) < 0.3);
  CHECK(estimate.doubts.empty());
}

TEST_CASE("a wrong motion beside vehicles is doubted", "[odometry]") {
  // The lower the walls, the more points of vehicles there are for each of theirs.
  std::size_t doubts = 0;
  for (const double half_height : {1.0, 1.3, 1.5, 1.7, 2.0}) {
    CAPTURE(half_height);
    const FlatWorld world = motorway(half_height);
    const PoseEstimate estimate = estimate_poses({world});
    CHECK((error_of(estimate.poses, world) < 0.3 || !estimate.doubts.empty()));
    doubts += estimate.doubts.size();
    for (const std::string& doubt : estimate.doubts) {
      CHECK(doubt.find("also fit a motion of") != std::string::npos);
    }
  }
  CHECK(doubts > 0);
}

TEST_CASE("a wrong first step is corrected by the scans after it", "[odometry]") {
  // The sensor moves 0.6 m a scan, and the first motion is given as 0.4 m back.
  FlatWorld world;
  for (int i = 0; i < 10; ++i) {
    world.scan(room({0.15, 0.15, 0.1}), pose_at(0.6 * i - 2.0, 0.0, 0.0), 0.1 * i);
  }
  MovingScans input{world};
  input.scale = scale_of(world.load(5));
  const Steps steps = odometry_of(input, {world.size(), pose_at(-0.4, 0.0, 0.0), true}, nullptr);
  CHECK(error_of(steps.poses(), world) < 0.02);
}

TEST_CASE("a turn that is too fast is doubted", "[odometry]") {
  FlatWorld world;
  for (int i = 0; i < 10; ++i) {
    world.scan(room({0.15, 0.15, 0.1}), pose_at(0.05 * i, 0.0, i < 7 ? 0.0 : 30.0));
  }
  const PoseEstimate estimate = estimate_poses({world});
  REQUIRE(estimate.doubts.size() == 1);
  CHECK(estimate.doubts[0].find("of the points of some scans lie on surfaces") !=
        std::string::npos);
}

TEST_CASE("a gap in time is reported, and the motion continues across it", "[odometry]") {
  FlatWorld world;
  for (int i = 0; i < 8; ++i) {
    world.scan(room({0.15, 0.15, 0.1}), pose_at(0.1 * i, 0.0, 0.0), 0.1 * i + (i < 4 ? 0.0 : 5.0));
  }
  const PoseEstimate estimate = estimate_poses({world});
  CHECK(error_of(estimate.poses, world) < 0.02);
  CHECK(all_notes(estimate).find("There is no scan for 5.1 s") != std::string::npos);
}

TEST_CASE("scans that do not overlap are refused by name", "[odometry]") {
  // Two sides of a wedge beside each other, then single walls far apart.
  FlatWorld world;
  world.scan(room(), Pose::Identity());
  world.scan(room(), pose_at(0.1, 0.0, 0.0));
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  world.scan({{{30, 0, 20}, 10 * (x + y), 25 * z}}, Pose::Identity());
  try {
    (void)estimate_poses({world});
    FAIL("no error");
  } catch (const DataError& error) {
    CHECK(std::string(error.what()).find("does not overlap enough with the scans before it") !=
          std::string::npos);
    CHECK(std::string(error.what()).find("--poses FILE") != std::string::npos);
  }
}

namespace {

/// Scans of a corridor that is 4 m wide and has no end: random points on its floor and walls.
toy::HeldScans corridor_scans() {
  toy::HeldScans scans;
  for (unsigned index = 0; index < 6; ++index) {
    std::mt19937 random(index);
    std::uniform_real_distribution<float> ahead(-12.0F, 12.0F), high(-1.5F, 1.5F),
        side(-2.0F, 2.0F);
    std::vector<Eigen::Vector3f> points;
    for (int i = 0; i < 3000; ++i) {
      points.emplace_back(ahead(random), 2.0F, high(random));
      points.emplace_back(ahead(random), -2.0F, high(random));
      points.emplace_back(ahead(random), side(random), -1.5F);
    }
    scans.add(std::move(points), pose_at(0.3 * index, 0.0, 0.0));
  }
  return scans;
}

}  // namespace

TEST_CASE("a corridor without features is refused, and given poses serve there", "[odometry]") {
  const toy::HeldScans corridor = corridor_scans();
  try {
    (void)estimate_poses({corridor});
    FAIL("no error");
  } catch (const DataError& error) {
    const std::string message = error.what();
    CAPTURE(message);
    CHECK(message.find("The poses of 5 scans are uncertain") != std::string::npos);
    CHECK(message.find("scans 1 to 5") != std::string::npos);
    CHECK(message.find("--poses FILE") != std::string::npos);
  }
  std::vector<Pose> given;
  for (std::size_t i = 0; i < corridor.size(); ++i) given.push_back(corridor.pose(i));
  const PoseEstimate refined = refine_poses({corridor}, given);
  CHECK(error_of(refined.poses, corridor) < 0.1);
}

TEST_CASE("points are moved to the time of the scan", "[odometry]") {
  // The sensor moves 0.5 m along x in 0.1 s. A point that was measured 0.1 s after the time of the
  // scan is 0.5 m farther ahead in the frame of that time.
  Scan scan;
  scan.points = {{4.0F, 0.0F, 0.0F}, {4.0F, 3.0F, 0.0F}};
  const ThinnedScan thin = thinned(scan, {{0.0, 0.1}, pose_at(0.5, 0.0, 0.0), 0.1}, {4.0, 0.2});
  REQUIRE(thin.dense.size() == 2);
  CHECK(thin.dense[0].x() == Approx(4.0).margin(0.003));
  CHECK(thin.dense[1].x() == Approx(4.5).margin(0.003));
}

TEST_CASE("noise, a jump and drift on a return are refined away", "[odometry]") {
  const FlatWorld world = round_trip();
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.1);
  const auto wrong = [&](auto&& error) {
    std::vector<Pose> poses;
    for (std::size_t i = 0; i < world.size(); ++i) {
      poses.push_back(Eigen::Translation3d(error(i)) * world.pose(i));
    }
    return poses;
  };
  const std::vector<std::vector<Pose>> cases = {
      wrong([&](std::size_t) { return Vector3d(noise(random), noise(random), noise(random)); }),
      wrong([](std::size_t i) { return i < 25 ? Vector3d(0, 0, 0) : Vector3d(0.4, 1.0, 0); }),
      wrong([](std::size_t i) { return Vector3d(0, 0.03 * static_cast<double>(i), 0); })};
  for (const std::vector<Pose>& given : cases) {
    CAPTURE(error_of(given, world));
    const PoseEstimate refined = refine_poses({world}, given);
    CHECK(error_of(given, world) > 0.3);
    CHECK(error_of(refined.poses, world) < 0.06);
    CHECK(all_notes(refined).find("The poses are refined") != std::string::npos);
  }
}

TEST_CASE("refined poses do not depend on where the world's origin lies and its axes point",
          "[odometry]") {
  const FlatWorld world = round_trip();
  const Pose other = Eigen::Translation3d(1234.5, -678.25, 9.0) *
                     Eigen::AngleAxisd(33.0 * kDegree, Vector3d::UnitZ());
  std::vector<Pose> given, moved;
  for (std::size_t i = 0; i < world.size(); ++i) {
    given.push_back(Eigen::Translation3d(0.0, i < 25 ? 0.0 : 0.5, 0.0) * world.pose(i));
    moved.push_back(other * given.back());
  }
  const PoseEstimate refined = refine_poses({world}, given), there = refine_poses({world}, moved);
  CHECK(error_of(refined.poses, world) < 0.05);
  for (std::size_t i = 0; i < given.size(); ++i) {
    CHECK((other * refined.poses[i]).isApprox(there.poses[i], 1e-6));
  }
}

TEST_CASE("right poses are kept, also far from the origin", "[odometry]") {
  const FlatWorld world = round_trip();
  std::vector<Pose> given;
  for (std::size_t i = 0; i < world.size(); ++i) {
    given.push_back(Eigen::Translation3d(4e5, 5e6, 30.0) * world.pose(i));
  }
  const PoseEstimate refined = refine_poses({world}, given);
  for (std::size_t i = 0; i < given.size(); ++i) {
    CHECK((refined.poses[i].translation() - given[i].translation()).norm() < 0.02);
  }
}

}  // namespace raymoval::odometry
