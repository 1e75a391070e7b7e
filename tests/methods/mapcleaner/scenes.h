// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "core/angle.h"
#include "tests/methods/held_scans.h"

namespace raymoval::mapcleaner_test {

using WorldPoints = std::vector<Eigen::Vector3d>;

/// The sensor's position in hand-made scans: 1.7 m above the level ground z = 0.
inline const Eigen::Vector3d kSensor(0.05, 0.05, 1.7);

/// Ground points every 0.2 m, in the middle of terrain cells, within 12 m of the origin.
/// @param height of the ground at (x, y)
inline WorldPoints ground(const std::function<double(double, double)>& height) {
  WorldPoints points;
  for (int y = -60; y < 60; ++y) {
    for (int x = -60; x < 60; ++x) {
      const Eigen::Vector2d at(0.2 * x + 0.1, 0.2 * y + 0.1);
      if (at.norm() < 12.0) points.emplace_back(at.x(), at.y(), height(at.x(), at.y()));
    }
  }
  return points;
}
inline WorldPoints level_ground() {
  return ground([](double, double) { return 0.0; });
}

/// An upright face at `x`, as wide to either side as a sixth of that, from `low` to `high`, a point
/// every 5 cm: half a degree at 6 m, so that there is one in the window of each pixel.
inline void add_face(double x, double low, double high, WorldPoints& points) {
  const int side = static_cast<int>(x / 6.0 / 0.05);
  for (int i = -side; i <= side; ++i) {
    for (int k = 0; low + 0.05 * k < high; ++k) points.emplace_back(x, 0.05 * i, low + 0.05 * k);
  }
}

/// Four scans on rolling ground with holes, walls, movers, ghosts below the ground and lone points,
/// from sensors that turn and tilt.
inline toy::HeldScans random_scans(unsigned seed, const SensorModel& sensor) {
  std::mt19937 random(seed);
  const auto uniform = [&random](double low, double high) {
    return low + (high - low) * static_cast<double>(random() % 100000) / 1e5;
  };
  const auto height = [](double x, double y) {
    return 0.15 * std::sin(0.8 * x) + 0.1 * std::cos(0.7 * y) + (x > 6.5 ? 0.5 * (x - 6.5) : 0.0);
  };
  toy::HeldScans scans(sensor);
  for (int s = 0; s < 4; ++s) {
    WorldPoints points;
    for (int i = 0; i < 3500; ++i) {
      const double x = uniform(-9, 9), y = uniform(-9, 9);
      if (std::hypot(x - 2, y + 4) < 1.5) continue;
      points.emplace_back(x, y, height(x, y) + uniform(-0.03, 0.03));
    }
    for (int i = 0; i < 1500; ++i) {
      const double x = uniform(-9, 9);
      points.emplace_back(x, 9.1 + uniform(0, 0.05), uniform(0, 4));
      points.emplace_back(-9.5 + uniform(0, 0.05), x, uniform(0, 3));
    }
    for (int i = 0; i < 300; ++i) {
      points.emplace_back(3.0 + 0.1 * s, 1.2 * s + uniform(0, 0.9), uniform(0.1, 1.6));
      points.emplace_back(-5.0 + 1.3 * s + uniform(0, 0.4), -3.0, uniform(0.1, 1.8));
    }
    for (int i = 0; i < 20; ++i)
      points.emplace_back(uniform(-9, 9), uniform(-9, 9), uniform(-2, 3));
    Pose pose = Pose::Identity();
    pose.rotate(Eigen::AngleAxisd(0.4 * s, Eigen::Vector3d::UnitZ()));
    pose.rotate(Eigen::AngleAxisd(0.05 * s, Eigen::Vector3d(0.6, 0.8, 0.0)));
    pose.translation() << 0.5 * s, 0.1 * s, 1.5;
    scans.add_world(pose, points);
  }
  return scans;
}

}  // namespace raymoval::mapcleaner_test
