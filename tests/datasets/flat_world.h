// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/angle.h"
#include "tests/methods/held_scans.h"

namespace raymoval::test {

/// A flat piece of the world: `centre` + a `along` + b `across` with a and b from -1 to 1.
struct Rectangle {
  Eigen::Vector3d centre, along, across;
};

/// Scans of rectangles: rows from -25 to +15 degrees by 1, columns by 1.5 degrees.
class FlatWorld : public toy::HeldScans {
 public:
  void scan(const std::vector<Rectangle>& surfaces, const Pose& T_world_sensor,
            double time_s = 0.0) {
    Scan scan;
    scan.time_s = time_s;
    scan.T_world_sensor = T_world_sensor;
    for (double azimuth = 0.3; azimuth < 360.0; azimuth += 1.5) {
      for (double elevation = -25.0; elevation <= 15.0; elevation += 1.0) {
        const double level = std::cos(elevation * kDegree);
        const Eigen::Vector3d ray(level * std::cos(azimuth * kDegree),
                                  level * std::sin(azimuth * kDegree),
                                  std::sin(elevation * kDegree));
        const double range = nearest(surfaces, T_world_sensor, ray);
        if (range < 60.0) scan.points.push_back((range * ray).cast<float>());
      }
    }
    add_scan(std::move(scan));
  }
  void shuffle() {
    std::mt19937 random(5);
    for (Scan& scan : scans_) std::shuffle(scan.points.begin(), scan.points.end(), random);
  }

 private:
  static double nearest(const std::vector<Rectangle>& surfaces, const Pose& pose,
                        const Eigen::Vector3d& ray) {
    const Eigen::Vector3d from = pose.translation(), direction = pose.linear() * ray;
    double range = 1e300;
    for (const Rectangle& surface : surfaces) {
      const Eigen::Vector3d normal = surface.along.cross(surface.across);
      const double distance = normal.dot(surface.centre - from) / normal.dot(direction);
      if (!(distance > 0.0 && distance < range)) continue;
      const Eigen::Vector3d offset = from + distance * direction - surface.centre;
      const double a = offset.dot(surface.along) / surface.along.squaredNorm();
      const double b = offset.dot(surface.across) / surface.across.squaredNorm();
      if (std::abs(a) <= 1.0 && std::abs(b) <= 1.0) range = distance;
    }
    return range;
  }
};

/// The inner surfaces of a box around the origin in plan, from z = 0 up to `height`, metres.
inline std::vector<Rectangle> inside_of_box(double length, double width, double height) {
  const double x = length / 2, y = width / 2, z = height / 2;
  std::vector<Rectangle> surfaces;
  for (const double side : {-1.0, 1.0}) {
    surfaces.push_back({{0, 0, z + side * z}, {x, 0, 0}, {0, y, 0}});
    surfaces.push_back({{0, side * y, z}, {x, 0, 0}, {0, 0, z}});
    surfaces.push_back({{side * x, 0, z}, {0, y, 0}, {0, 0, z}});
  }
  return surfaces;
}
inline std::vector<Rectangle> hall() {
  return inside_of_box(40.0, 24.0, 6.0);
}

}  // namespace raymoval::test
