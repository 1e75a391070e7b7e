// SPDX-License-Identifier: MIT
#include "methods/erasor/body_frame.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/methods/erasor/scenes.h"

namespace raymoval::erasor_test {
using namespace raymoval::erasor_method;

namespace {

/// The points `at(x, y)` of a square of 24 m around `sensor`, 0.5 m apart.
template <class At>
std::vector<Eigen::Vector3d> points_around(const Eigen::Vector3d& sensor, At&& at) {
  std::vector<Eigen::Vector3d> points;
  for (int i = -24; i <= 24; ++i) {
    for (int j = -24; j <= 24; ++j) {
      const double x = sensor.x() + 0.5 * i, y = sensor.y() + 0.5 * j;
      points.emplace_back(x, y, at(x, y));
    }
  }
  return points;
}

NaiveMap map_of(const std::vector<Eigen::Vector3d>& points) {
  std::vector<VoxelKey> keys;
  for (const Eigen::Vector3d& point : points) {
    keys.push_back(voxel_key(voxel_index(point, 1.0 / 0.2)));
  }
  NaiveMapBuilder builder;
  builder.add(keys, points);
  return builder.finish();
}

/// A map of one scan with the points `at(x, y)` of a square of 24 m around `sensor`, 0.5 m apart.
template <class At>
NaiveMap ground_map(const Eigen::Vector3d& sensor, At&& at) {
  return map_of(points_around(sensor, at));
}

Parameters on_the_ground() {
  Parameters parameters;
  parameters.body = Body::kGround;
  return parameters;
}

Pose sensor_at(const Eigen::Vector3d& position, const Eigen::AngleAxisd& turn) {
  Pose pose = Pose::Identity();
  pose.translation() = position;
  pose.linear() = turn.toRotationMatrix();
  return pose;
}

}  // namespace

TEST_CASE("as published the body is the sensor, lifted", "[erasor]") {
  const Eigen::Vector3d sensor(5, 7, 40);
  const NaiveMap map = ground_map(sensor, [](double, double) { return 30.0; });
  const Pose pose = sensor_at(sensor, {0.5, Eigen::Vector3d::UnitY()});
  Pose lifted = Pose::Identity();
  lifted.translation().z() = 1.73;
  CHECK(body_frame(pose, map, Parameters{}).isApprox(lifted));
}

TEST_CASE("the body stands on the ground below a sensor, however it is held", "[erasor]") {
  const Eigen::Vector3d sensor(105, -57, 41.2);
  const NaiveMap map = ground_map(sensor, [](double, double) { return 40.0; });
  // Turned by 0.4 to the left, then tilted by 35 degrees: its x axis keeps that heading.
  Pose pose = sensor_at(sensor, {0.4, Eigen::Vector3d::UnitZ()});
  pose.linear() =
      pose.linear() * Eigen::AngleAxisd(35 * kDegree, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const Pose T_body_sensor = body_frame(pose, map, on_the_ground());
  CHECK(T_body_sensor.translation().isApprox(Eigen::Vector3d(0, 0, 1.2), 1e-9));
  const Pose T_body_world = T_body_sensor * pose.inverse();
  // 2 m ahead and 1 m above the ground.
  const Eigen::Vector3d ahead(sensor.x() + 2 * std::cos(0.4), sensor.y() + 2 * std::sin(0.4), 41.0);
  CHECK((T_body_world * ahead).isApprox(Eigen::Vector3d(2, 0, 1), 1e-9));
}

TEST_CASE("the body lies on a slope as the ground does", "[erasor]") {
  const Eigen::Vector3d sensor(3, 4, 10);
  const double slope = 0.18;
  const NaiveMap map =
      ground_map(sensor, [&](double x, double) { return 8.5 + slope * (x - sensor.x()); });
  const Pose pose = sensor_at(sensor, {0.0, Eigen::Vector3d::UnitZ()});
  const Pose T_body_world = body_frame(pose, map, on_the_ground()) * pose.inverse();
  for (const double x : {-10.0, 0.0, 10.0}) {
    const Eigen::Vector3d ground(sensor.x() + x, sensor.y() + 3, 8.5 + slope * x);
    CHECK(std::abs((T_body_world * ground).z()) < 0.02);
  }
}

TEST_CASE("what stands on the ground and what floats below it leave the body where it is",
          "[erasor]") {
  const Eigen::Vector3d sensor(0, 0, 1.5);
  const NaiveMap map = ground_map(sensor, [](double x, double y) {
    if (std::abs(x) > 4 && std::abs(x) < 6) return 0.9;  // Cars on both sides.
    const bool is_echo = x == 0.5 && y == 0.5;
    return is_echo ? -2.0 : 0.0;
  });
  const Pose pose = sensor_at(sensor, {0.0, Eigen::Vector3d::UnitZ()});
  const Pose T_body_sensor = body_frame(pose, map, on_the_ground());
  CHECK(T_body_sensor.translation().z() == Approx(1.5).margin(0.02));
  CHECK(T_body_sensor.linear().isApprox(Eigen::Matrix3d::Identity(), 0.01));
}

TEST_CASE("a storey below the sensor's and a bridge above it are not its ground", "[erasor]") {
  // Roads at 0, 5.2 and 10.4 m, the upper two with a slope of 5 percent, and a sensor on each.
  const auto road = [](int storey) {
    return [=](double x, double) { return 5.2 * storey + (storey > 0 ? 0.05 * x : 0.0); };
  };
  std::vector<Eigen::Vector3d> points;
  for (int storey = 0; storey < 3; ++storey) {
    const auto of_storey = points_around({0, 0, 0}, road(storey));
    points.insert(points.end(), of_storey.begin(), of_storey.end());
  }
  const NaiveMap map = map_of(points);
  for (int storey = 0; storey < 3; ++storey) {
    const Pose pose = sensor_at({0, 0, 5.2 * storey + 1.7}, {0.0, Eigen::Vector3d::UnitZ()});
    const Pose T_body_world = body_frame(pose, map, on_the_ground()) * pose.inverse();
    CAPTURE(storey);
    for (const double x : {-8.0, 0.0, 8.0}) {
      CHECK(std::abs((T_body_world * Eigen::Vector3d(x, 2, road(storey)(x, 2))).z()) < 0.02);
    }
  }
}

TEST_CASE("roofs beside the sensor are not its ground, though nothing is seen below some",
          "[erasor]") {
  // A sensor at 1.9 m. Of six columns around it two have the roof of a car at 1.4 m, and of these
  // two one has the road below.
  int column = 0;
  std::vector<Eigen::Vector3d> points =
      points_around({0, 0, 1.9}, [&](double, double) { return ++column % 6 == 0 ? 1.4 : 0.0; });
  column = 0;
  const auto more = points_around({0, 0, 1.9}, [&](double, double) {
    const int place = ++column % 6;
    return place == 0 || place == 1 ? 1.4 : 0.0;
  });
  points.insert(points.end(), more.begin(), more.end());
  const Pose pose = sensor_at({0, 0, 1.9}, {0.0, Eigen::Vector3d::UnitZ()});
  CHECK(body_frame(pose, map_of(points), on_the_ground()).translation().z() ==
        Approx(1.9).margin(0.02));
}

TEST_CASE("the own car is told by a level distance where the body is on the ground", "[erasor]") {
  Parameters parameters;
  const Pose tilted = sensor_at({7, 8, 9}, {35 * kDegree, Eigen::Vector3d::UnitY()});
  // Points by where they are from the sensor along the world's axes.
  const auto seen = [&](const Eigen::Vector3d& ahead) {
    return Eigen::Vector3d(tilted.linear().transpose() * ahead).cast<float>().eval();
  };
  const Eigen::Vector3f far = seen({3.2, 0, 0}), near = seen({2.6, 0, -1.5});
  CHECK(is_ego_vehicle(far, tilted, parameters));         // 3.2 * cos 35 = 2.62.
  CHECK_FALSE(is_ego_vehicle(near, tilted, parameters));  // 2.6 * cos 35 + 1.5 * sin 35 = 2.99.
  parameters.body = Body::kGround;
  CHECK_FALSE(is_ego_vehicle(far, tilted, parameters));
  CHECK(is_ego_vehicle(near, tilted, parameters));
}

TEST_CASE("without ground below it the sensor is as high as it is said to be", "[erasor]") {
  const NaiveMap map = ground_map({100, 100, 0}, [](double, double) { return 0.0; });
  const Pose pose = sensor_at({0, 0, 5}, {0.3, Eigen::Vector3d::UnitY()});
  const Pose T_body_sensor = body_frame(pose, map, on_the_ground());
  CHECK(T_body_sensor.translation().z() == 1.73);
  // Still level.
  CHECK((T_body_sensor.linear() * pose.linear().transpose())
            .isApprox(Eigen::Matrix3d::Identity(), 1e-9));
}

TEST_CASE("a sensor that looks straight down has some heading", "[erasor]") {
  const Eigen::Vector3d sensor(0, 0, 1.5);
  const NaiveMap map = ground_map(sensor, [](double, double) { return 0.0; });
  const Pose pose = sensor_at(sensor, {90 * kDegree, Eigen::Vector3d::UnitY()});
  const Pose T_body_sensor = body_frame(pose, map, on_the_ground());
  CHECK(T_body_sensor.linear().isUnitary(1e-9));
  CHECK((T_body_sensor * pose.inverse() * Eigen::Vector3d(1, 1, 0.5)).z() == Approx(0.5));
}

TEST_CASE("fewer beams leave fewer points in a bin", "[erasor]") {
  Parameters parameters;
  const auto points = [&](const char* sensor) {
    return minimum_points_of(sensor_model_named(sensor), parameters);
  };
  CHECK(points("vlp16") == 6);
  parameters.points_by_beams = true;
  CHECK(points("hdl64e") == 6);
  CHECK(points("os1-128") == 6);                             // More beams require no more points.
  CHECK(points("hdl32e") == 2);                              // 6 * 0.43 / 1.33 degrees.
  CHECK(points("vlp16") == 1);                               // 6 * 0.43 / 2.
  CHECK(minimum_points_of(SensorModel{}, parameters) == 6);  // Unknown steps.
}

TEST_CASE("a tilted sensor at another height finds what an upright one finds", "[erasor]") {
  // The car of 1.5 m on a road, seen from 1.2 m, tilted by 35 degrees.
  Parameters parameters = small_grid();
  parameters.body = Body::kGround;
  parameters.maximum_height = 2.0;
  Pose pose = sensor_at({50, 60, 71.2}, {35 * kDegree, Eigen::Vector3d::UnitY()});
  const auto seen = [&](Points points) {
    // Ground below the sensor, in other bins than the car's.
    for (int i = -5; i <= 5; ++i) {
      for (int j = -5; j <= 5; ++j) {
        points.emplace_back(-1.5F + 0.25F * static_cast<float>(i), 0.25F * static_cast<float>(j),
                            0);
      }
    }
    for (Eigen::Vector3f& point : points) {
      const Eigen::Vector3d world = point.cast<double>() + Eigen::Vector3d(50, 60, 70);
      point = (pose.inverse() * world).cast<float>();
    }
    return points;
  };
  Points empty = road();
  empty[0].z() = 0.05F;
  HeldScans scans;
  scans.add(seen(road_and({0.6F, 1.0F, 1.5F})), pose);
  scans.add(seen(empty), pose);
  CHECK(removed_points(scans, parameters)[0] == std::vector{4, 5, 6});
  // In the sensor's own frame the road is no plane of the bins.
  parameters.body = Body::kSensor;
  parameters.sensor_height = 1.2;
  CHECK(removed_points(scans, parameters)[0] != std::vector{4, 5, 6});
}

}  // namespace raymoval::erasor_test
