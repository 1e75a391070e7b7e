// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/scan/scan_source.h"
#include "datasets/layout.h"

namespace raymoval {

/// An axis-aligned box of the world that may move at constant velocity.
struct StreetBox {
  Eigen::Vector3d min, max;                            ///< Corners at time 0, metres, world frame.
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< Metres per second.
  std::uint32_t label = 0;                             ///< Label word (SemanticKITTI).
};

/// An ideal spinning sensor that drives along +x over the ground z = 0 (label 40, road).
struct StreetParameters {
  std::size_t scans = 50;
  double scan_period_s = 0.1;
  double metres_per_scan = 1.0;
  double sensor_height = 1.8;  ///< World z of the sensor; it starts at x = y = 0.
  int beams = 32;              ///< Evenly spaced from lowest to highest elevation, both included.
  double elevation_min_deg = -25.0;
  double elevation_max_deg = 10.0;
  int columns = 720;        ///< Directions per revolution; the first is along -x.
  double range_max = 60.0;  ///< Farther surfaces have no point.
};

/// The street: two walls, two poles, a parked car, an oncoming car, and a crossing pedestrian.
/// Labels 50, 80, 10, 252 and 254, the last three with instance ids.
std::vector<StreetBox> street_boxes();

/// Makes a sequence of `boxes` on the ground, in memory: exact ranges in closed form (ray-plane
/// and ray-box), exact labels, deterministic.
/// @param options frames, label rule, ranges, sensor and name; the sensor is the ideal one unless
///   the options name another
/// @throws UsageError if the options name a pose file or the parameters make no scan
Sequence make_street(const StreetParameters& parameters, const std::vector<StreetBox>& boxes,
                     const SequenceOptions& options = {});

/// The built-in scene `street`.
Layout street_layout();

}  // namespace raymoval
