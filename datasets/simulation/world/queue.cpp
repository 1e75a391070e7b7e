// SPDX-License-Identifier: MIT
#include "datasets/simulation/world/queue.h"

#include <algorithm>
#include <cmath>

namespace raymoval::simulated {
namespace {

/// Stands from `arrival` to `start` (seconds), drives at the queue's speed before and after.
SpeedProfile stop_and_go(const QueueSpec& spec, double arrival, double start) {
  const double ramp = spec.speed_mps / spec.acceleration_mps2;
  return SpeedProfile({{arrival - ramp, spec.speed_mps},
                       {arrival, 0.0},
                       {start, 0.0},
                       {start + ramp, spec.speed_mps}});
}

SpeedProfile go(const QueueSpec& spec, double start) {
  return SpeedProfile(
      {{start, 0.0}, {start + spec.speed_mps / spec.acceleration_mps2, spec.speed_mps}});
}

}  // namespace

std::vector<QueuePlace> queue_places(const QueueSpec& spec, const std::vector<double>& lengths_m,
                                     Random& random) {
  std::vector<QueuePlace> places;
  const std::size_t count = lengths_m.size();
  const auto standing =
      static_cast<std::size_t>(std::lround(spec.arrived * static_cast<double>(count)));
  double start = spec.start_s;
  double at = spec.line_m;
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) {
      start += random.between(spec.reaction_s.low, spec.reaction_s.high);
      at -= 0.5 * lengths_m[i - 1] + random.between(spec.gap_m.low, spec.gap_m.high);
    }
    at -= 0.5 * lengths_m[i];
    QueuePlace place;
    place.left_m = random.between(spec.side_m.low, spec.side_m.high);
    if (i < standing) {
      place.speed = go(spec, start);
    } else {
      // Those who come do so evenly over nine tenths of the time that the heads wait.
      const double share =
          static_cast<double>(i - standing + 1) / static_cast<double>(count - standing);
      place.speed = stop_and_go(spec, 0.9 * share * spec.start_s, start);
    }
    place.start_m = at - place.speed.distance(std::max(0.0, start));
    places.push_back(std::move(place));
  }
  return places;
}

}  // namespace raymoval::simulated
