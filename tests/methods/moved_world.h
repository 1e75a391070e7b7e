// SPDX-License-Identifier: MIT
#pragma once

#include <random>

#include "methods/registry.h"
#include "tests/methods/toy_world.h"

namespace raymoval::toy {

/// Cells of octomap of 0.2 m: smaller ones along all beams take most of a test's time, and
/// the variants with them have no other rules.
inline void coarsen_octomap(ConfiguredMethod& method) {
  if (method.entry->name != "octomap") return;
  set_parameter(method.configuration, "resolution", 0.2);
}

/// Moves the world by (x, y, z) metres after a turn by `quarters` times 90 degrees about z. The
/// turn's matrix is exact.
inline Pose whole_motion(double x, double y, double z, int quarters) {
  static constexpr int kCosine[] = {1, 0, -1, 0};
  static constexpr int kSine[] = {0, 1, 0, -1};
  const int c = kCosine[quarters & 3], s = kSine[quarters & 3];
  Pose motion = Pose::Identity();
  motion.matrix().topRows<3>() << c, -s, 0, x, s, c, 0, y, 0, 0, 1, z;
  return motion;
}

/// A road with walls, a pole and two movers: a car (box 3) that drives off and a crossing person
/// (box 4). Every coordinate is off the lattices of 0.05 m and its multiples, so that no surface is
/// on a voxel wall. The sensor is 1.6 m above the road and moves 0.7 m per scan.
inline World street(int scans, unsigned seed = 7, const Scanner& scanner = {}) {
  std::mt19937 random(seed);
  const auto off_lattice = [&random] {
    return 0.0071 + 0.03 * static_cast<double>(random() % 1000) / 1000.0;
  };
  World world{scanner};
  const double road = -1.63 + off_lattice();
  const std::vector<Box> fixed{{{-40, -40, road - 0.5}, {40, 40, road}},
                               {{-30, 9.0 + off_lattice(), road}, {30, 9.5, 2.4}},
                               {{6.0 + off_lattice(), -5.0, road}, {6.3, -4.7, 2.0}}};
  for (int i = 0; i < scans; ++i) {
    std::vector<Box> boxes = fixed;
    const double car = 4.0 + 1.1 * i + off_lattice(), person = -6.0 + 0.45 * i + off_lattice();
    boxes.push_back({{car, -2.1, road}, {car + 3.9, -0.4, road + 1.45}});
    boxes.push_back({{9.0, person, road}, {9.5, person + 0.45, road + 1.7}});
    Pose pose = Pose::Identity();
    pose.translation() << 0.7 * i + off_lattice(), off_lattice(), off_lattice();
    world.scan(boxes, pose);
  }
  return world;
}

/// Number of points whose verdict differs between two runs of equal scans.
inline std::size_t different_verdicts(const MaskStore& a, const MaskStore& b, std::size_t scans) {
  std::size_t differences = 0;
  for (std::size_t i = 0; i < scans; ++i) {
    const Mask of_a = a.get(i), of_b = b.get(i);
    for (std::size_t k = 0; k < of_a.size(); ++k) differences += of_a[k] != of_b[k] ? 1 : 0;
  }
  return differences;
}

/// Number of points whose verdict changes when the world is moved by `motion`: poses become
/// `motion * pose`, points stay as they are in the sensor frame.
inline std::size_t verdicts_changed_by(const Pose& motion, const ConfiguredMethod& method,
                                       const ScanSource& scans) {
  const MaskStore here = masks_of(*method.make(), scans);
  const ChangedScans moved(scans,
                           [&](Scan& scan) { scan.T_world_sensor = motion * scan.T_world_sensor; });
  const MaskStore there = masks_of(*method.make(), moved);
  return different_verdicts(here, there, scans.size());
}

}  // namespace raymoval::toy
