// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/angle.h"
#include "core/scan/scan_source.h"

namespace raymoval::test {

/// A flat piece of the world: `centre` + a `along` + b `across` with a and b from -1 to 1.
struct Rectangle {
  Eigen::Vector3d centre, along, across;
};

/// Scans of rectangles: rows from -25 to +15 degrees by 1, columns by 1.5 degrees.
class FlatWorld : public ScanSource {
 public:
  void scan(const std::vector<Rectangle>& surfaces, const Pose& T_world_sensor,
            double time_s = 0.0) {
    Scan scan;
    scan.time_s = time_s;
    scan.index = scans_.size();
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
    scan.stored_point_count = scan.size();
    scans_.push_back(scan);
  }
  void shuffle() {
    std::mt19937 random(5);
    for (Scan& scan : scans_) std::shuffle(scan.points.begin(), scan.points.end(), random);
  }
  [[nodiscard]] std::size_t size() const override { return scans_.size(); }
  [[nodiscard]] Scan load(std::size_t index) const override { return scans_.at(index); }
  [[nodiscard]] Pose pose(std::size_t index) const override {
    return scans_.at(index).T_world_sensor;
  }
  [[nodiscard]] const SensorModel& sensor() const override { return model_; }

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
  std::vector<Scan> scans_;
  SensorModel model_;
};

/// A hall of 40 x 24 m and 6 m in height.
inline std::vector<Rectangle> hall() {
  std::vector<Rectangle> surfaces;
  for (const double z : {0.0, 6.0}) surfaces.push_back({{0, 0, z}, {20, 0, 0}, {0, 12, 0}});
  for (const double y : {-12.0, 12.0}) surfaces.push_back({{0, y, 3}, {20, 0, 0}, {0, 0, 3}});
  for (const double x : {-20.0, 20.0}) surfaces.push_back({{x, 0, 3}, {0, 12, 0}, {0, 0, 3}});
  return surfaces;
}

}  // namespace raymoval::test
