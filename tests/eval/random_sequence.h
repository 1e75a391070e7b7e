// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <random>

#include "tests/eval/memory_sequence.h"

namespace raymoval::test {

/// How the coordinates of a random cloud are drawn.
enum class Coordinates { kFree, kOnWalls };

struct CloudShape {
  unsigned seed = 0;
  std::size_t scans = 3;
  std::size_t points = 150;
  float extent = 1.5f;  ///< Half width of each of the clumps.
  Coordinates coordinates = Coordinates::kFree;
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
};

inline float coordinate(const CloudShape& shape, std::mt19937& random) {
  if (shape.coordinates == Coordinates::kFree) {
    return std::uniform_real_distribution<float>(-shape.extent, shape.extent)(random);
  }
  // Multiples of 1/16: every fourth lies on a wall of the 0.25 m lattice.
  const int steps = static_cast<int>(shape.extent * 16.0f);
  return static_cast<float>(std::uniform_int_distribution<int>(-steps, steps)(random)) / 16.0f;
}

inline LabelledScan random_scan(const CloudShape& shape, std::mt19937& random) {
  static const std::uint32_t kLabels[] = {0, 1, 40, 50, 70, 252, 258, 251, 327933, 99};
  const bool walls = shape.coordinates == Coordinates::kOnWalls;
  std::uniform_real_distribution<double> angle(-3.1, 3.1);
  LabelledScan scan;
  // On walls the poses keep to the lattice's steps, a quarter turn or none.
  const double turn = walls ? (random() % 2 == 0 ? 0.0 : 1.5707963267948966) : angle(random);
  if (!walls || turn != 0.0) {
    Eigen::Matrix3d rotation = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).matrix();
    if (walls) rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    scan.pose.linear() = rotation;
  }
  scan.pose.translation() = shape.offset;
  std::bernoulli_distribution flagged(0.4);
  for (std::size_t i = 0; i < shape.points; ++i) {
    const float side = random() % 2 == 0 ? 3.5f : -3.5f;
    // Compilers evaluate the arguments of a call in different orders.
    const bool is_removed = flagged(random);
    const std::uint32_t label = kLabels[random() % 10];
    const float z = 0.4f * coordinate(shape, random);
    const float y = coordinate(shape, random);
    scan.add(side + coordinate(shape, random), y, z, label, is_removed);
  }
  return scan;
}

inline MemorySequence random_sequence(const CloudShape& shape) {
  std::mt19937 random(shape.seed);
  std::vector<LabelledScan> scans;
  for (std::size_t i = 0; i < shape.scans; ++i) scans.push_back(random_scan(shape, random));
  return MemorySequence(scans);
}

}  // namespace raymoval::test
