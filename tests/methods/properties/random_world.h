// SPDX-License-Identifier: MIT
#pragma once

#include <random>

#include "tests/methods/held_scans.h"

namespace raymoval::toy {

/// What a random world consists of.
struct WorldPlan {
  int scans = 0;
  int walls = 0;   ///< Standing boxes of any size.
  int movers = 0;  ///< Cars and people.
  unsigned seed = 0;
};

/// A number in [low, high), the same from every standard library.
double number_between(double low, double high, std::mt19937& random);

/// A road with standing and moving boxes, before a sensor that drives along it and sees 150 degrees
/// ahead in steps of 1.5 degrees, 21 rows, up to 25 m. Ranges are noisy by a centimetre and
/// directions by a tenth of a degree, so that no point lies on a wall of a lattice or on the border
/// of a pixel. One tick of 0.1 s is between scans.
HeldScans random_world(const WorldPlan& plan);

}  // namespace raymoval::toy
