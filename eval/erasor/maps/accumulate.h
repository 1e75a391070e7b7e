// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "eval/checked_scan.h"
#include "eval/erasor/maps/map_voxels.h"
#include "eval/erasor/options.h"
#include "eval/points/labelled_voxels.h"
#include "eval/protocol.h"

namespace raymoval::erasor {

/// What became of the points of all scans. The first four counts add up to the points that were
/// read.
struct PointCounts {
  std::int64_t out_of_range = 0;  ///< Outside the range limits.
  std::int64_t ignored = 0;       ///< Of an ignored label class.
  std::int64_t cropped = 0;       ///< Too near to the sensor's z axis.
  std::int64_t evaluated = 0;     ///< Everything else.
  std::int64_t removed = 0;       ///< Evaluated points that the mask flags.
  std::int64_t trucks = 0;        ///< Evaluated points of label id 258.

  PointCounts& operator+=(const PointCounts& other);
};

/// The label rule as the options want it: id 258 moves only with `truck_is_moving`.
LabelRule effective_rule(const LabelRule& rule, const Options& options);

/// What makes a map of scans. All parts outlive what is made with them.
struct MapRules {
  const EvaluationInput& input;
  const Options& options;
  const LabelClasses& classes;
};

/// Points of a scan in the world frame, lifted.
struct PlacedScan {
  LabelledCloud cloud;
  PointCounts points;  ///< Of the whole scan.
};

/// Steps 1 to 3 of the ground truth for one scan: crop, lift in the sensor frame, pose.
/// @return the points that are evaluated and not flagged
PlacedScan place_scan(const CheckedScan& scan, const MapRules& rules);

/// The points that are evaluated and flagged.
PlacedScan place_flagged(const CheckedScan& scan, const MapRules& rules);

/// The dense map, point by point: the voxels of all scans, one scan after the other. For searches
/// of the nearest point however far away; a map of voxels needs none of it (see `TruthMap`).
/// @param task shown as progress
/// @throws DataError if a scan's labels do not fit it
LabelledCloud dense_map(const MapRules& rules, const std::string& task);

}  // namespace raymoval::erasor
