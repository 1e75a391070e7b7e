// SPDX-License-Identifier: MIT
#pragma once

#include <random>
#include <vector>

#include "core/angle.h"
#include "tests/methods/toy_world.h"

namespace raymoval::hmm_mos_test {

/// An object before a wall for some scans: a plate across the view, metres.
struct Plate {
  double x = 2.5, y = -0.4, z = -0.4;
  double width = 0.7, height = 0.8;
  double step = 0.0;             ///< Along y, from scan to scan.
  int first = 0, last = 100000;  ///< Scans in which it is there.
};

/// Scans of a wall 4 m before the sensor, 36 by 36 rays of 1.25 degrees, and of plates before it.
/// Nothing lies on a lattice of voxels.
inline toy::HeldScans wall_with(const std::vector<Plate>& plates, int scans, unsigned seed = 7,
                                double drive = 0.0) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> noise(-0.01, 0.01);
  toy::HeldScans held;
  for (int i = 0; i < scans; ++i) {
    const Eigen::Vector3d sensor(0.011 + drive * i, 0.017 - 0.5 * drive * i, 0.013);
    std::vector<Eigen::Vector3d> points;
    for (int ray = 0; ray < 36 * 36; ++ray) {
      const double azimuth = (ray % 36 - 17.6) * 1.25 * kDegree;
      const double elevation = (ray / 36 - 17.4) * 1.25 * kDegree;
      const Eigen::Vector3d direction(1.0, std::tan(azimuth), std::tan(elevation));
      Eigen::Vector3d hit = sensor + (4.1 - sensor.x()) * direction;
      for (const Plate& plate : plates) {
        if (i < plate.first || i > plate.last) continue;
        const Eigen::Vector3d at = sensor + (plate.x - sensor.x()) * direction;
        const double y = at.y() - plate.y - plate.step * i, z = at.z() - plate.z;
        if (y >= 0.0 && y <= plate.width && z >= 0.0 && z <= plate.height) hit = at;
      }
      points.push_back(hit + noise(random) * direction);
    }
    held.add_world(sensor, points);
  }
  return held;
}

/// A plate that crosses the view, of which it is in the middle at scan `middle`.
inline toy::HeldScans wall_and_mover(int scans, int middle, unsigned seed = 7, double drive = 0.0) {
  Plate mover;
  mover.width = 0.9;
  mover.height = 1.2;
  mover.z = -0.6;
  mover.step = 0.4;
  mover.y = -0.45 - mover.step * middle;
  return wall_with({mover}, scans, seed, drive);
}

}  // namespace raymoval::hmm_mos_test
