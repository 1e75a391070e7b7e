// SPDX-License-Identifier: MIT
#include "tests/methods/properties/random_world.h"

#include "tests/methods/toy_world.h"

namespace raymoval::toy {
namespace {

constexpr double kStep = 1.5, kHalfView = 75.0, kLowest = -20.0;  // Degrees.
constexpr int kRows = 21;
constexpr double kRange = 25.0, kNoise = 0.01;
constexpr double kJitter = 0.1;  // Degrees.

SensorModel coarse_sensor() {
  SensorModel sensor;
  sensor.azimuth_min = -kHalfView * kDegree;
  sensor.azimuth_max = kHalfView * kDegree;
  sensor.elevation_min = kLowest * kDegree;
  sensor.elevation_max = (kLowest + (kRows - 1) * kStep) * kDegree;
  sensor.azimuth_step = sensor.elevation_step = kStep * kDegree;
  sensor.range_max = kRange;
  sensor.missing_return_is_meaningful = true;
  return sensor;
}

struct Mover {
  Box box;
  Eigen::Vector3d velocity;  ///< Metres a scan.
};

Box box_at(double x, double y, const Eigen::Vector3d& size, double road) {
  return {{x, y, road}, {x + size.x(), y + size.y(), road + size.z()}};
}

Mover random_mover(double road, std::mt19937& random) {
  const auto between = [&](double low, double high) { return number_between(low, high, random); };
  const double x = between(4.0, 12.0);
  if (random() % 2 == 0) {
    return {box_at(x, between(-4.0, 2.0), {3.9, 1.7, 1.45}, road), {between(0.6, 1.4), 0.0, 0.0}};
  }
  const double side = random() % 2 == 0 ? 1.0 : -1.0;
  return {box_at(x, -4.0 * side, {0.5, 0.45, 1.7}, road),
          {between(-0.2, 0.2), side * between(0.4, 0.9), 0.0}};
}

std::vector<Eigen::Vector3f> returns(const std::vector<Box>& boxes, const Pose& T_world_sensor,
                                     std::mt19937& random) {
  std::vector<Eigen::Vector3f> points;
  for (double azimuth = -kHalfView + kStep / 2.0; azimuth < kHalfView; azimuth += kStep) {
    for (int row = 0; row < kRows; ++row) {
      const double a = (azimuth + number_between(-kJitter, kJitter, random)) * kDegree;
      const double e =
          (kLowest + row * kStep + number_between(-kJitter, kJitter, random)) * kDegree;
      const Eigen::Vector3d ray = direction(a, e);
      double range = kRange;
      for (const Box& box : boxes) {
        range = std::min(range, enter_distance(box, T_world_sensor.translation(),
                                               T_world_sensor.linear() * ray));
      }
      if (range >= kRange) continue;
      points.emplace_back(((range + number_between(-kNoise, kNoise, random)) * ray).cast<float>());
    }
  }
  return points;
}

}  // namespace

double number_between(double low, double high, std::mt19937& random) {
  return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
}

HeldScans random_world(const WorldPlan& plan) {
  std::mt19937 random(plan.seed);
  const auto between = [&](double low, double high) { return number_between(low, high, random); };
  const double road = between(-1.7, -1.6), speed = between(0.2, 0.9);
  std::vector<Box> standing{{{-40.0, -40.0, road - 0.5}, {60.0, 40.0, road}}};
  for (int i = 0; i < plan.walls; ++i) {
    const double side = random() % 2 == 0 ? between(3.0, 9.0) : between(-12.0, -6.0);
    standing.push_back(box_at(between(0.0, 18.0), side,
                              {between(0.2, 8.0), between(0.2, 3.0), between(0.5, 3.5)}, road));
  }
  std::vector<Mover> movers;
  for (int i = 0; i < plan.movers; ++i) movers.push_back(random_mover(road, random));

  HeldScans world(coarse_sensor());
  for (int i = 0; i < plan.scans; ++i) {
    std::vector<Box> boxes = standing;
    for (const Mover& mover : movers) {
      boxes.push_back({mover.box.low + i * mover.velocity, mover.box.high + i * mover.velocity});
    }
    const Pose T_world_sensor = Eigen::Translation3d(speed * i, between(-0.05, 0.05), 0.0) *
                                Eigen::AngleAxisd(between(-0.05, 0.05), Eigen::Vector3d::UnitZ());
    world.add(returns(boxes, T_world_sensor, random), T_world_sensor);
  }
  return world;
}

}  // namespace raymoval::toy
