// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/files/fields.h"
#include "datasets/simulation/shapes/random.h"
#include "datasets/simulation/world/path.h"

namespace raymoval::simulated {

/// Traffic that comes up to a line, stands there nose to tail, and leaves one after another.
struct QueueSpec {
  std::string road;
  bool reverse = false;
  std::vector<double> lanes_m;   ///< A column in each, left of the road's middle, seen along it.
  double line_m = 0.0;           ///< Distance along the route where the heads of the columns stand.
  int count = 10;                ///< In each column.
  NumberRange gap_m{1.0, 3.0};   ///< From bumper to bumper.
  NumberRange side_m{0.0, 0.0};  ///< Left of the middle of the column.
  std::vector<std::pair<std::string, double>> kinds;  ///< With weights.
  double arrived = 1.0;   ///< Share of each column that stands already when the sequence begins.
  double start_s = 10.0;  ///< When the heads may go.
  NumberRange reaction_s{0.4, 1.2};  ///< Each goes this long after the one before it.
  double speed_mps = 8.0;            ///< Of those who come and of those who go.
  double acceleration_mps2 = 2.0;
};

/// One of a column: where it stands and how it gets there and away.
struct QueuePlace {
  double start_m = 0.0;  ///< Distance along the route at time 0.
  double left_m = 0.0;
  SpeedProfile speed;
};

/// Places of one column in their order, for bodies of `lengths_m` metres. Nobody ever drives into
/// the one before: all brake and gain speed alike, and later than those before them.
std::vector<QueuePlace> queue_places(const QueueSpec& spec, const std::vector<double>& lengths_m,
                                     Random& random);

}  // namespace raymoval::simulated
