// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <utility>
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

/// Which of the counts a point belongs to. @param point sensor frame
inline std::int64_t PointCounts::*fate_of(const Eigen::Vector3d& point, LabelClass label_class,
                                          const MapRules& rules) {
  if (!rules.input.range_m.contains(point.norm())) return &PointCounts::out_of_range;
  if (label_class == LabelClass::kIgnored) return &PointCounts::ignored;
  const double limit = rules.options.minimum_horizontal_range;
  const double horizontal_squared = point.x() * point.x() + point.y() * point.y();
  return horizontal_squared < limit * limit ? &PointCounts::cropped : &PointCounts::evaluated;
}

/// World pose of a scan in the frame that the options want.
Pose pose_of(const Scan& scan, const MapRules& rules);

/// Steps 1 to 3 of the ground truth for one scan: crop, lift in the sensor frame, pose. Calls
/// `visit(point, label)` for each point that is evaluated and, as is asked for, flagged or not.
/// @param is_wanted of a point in the world says whether it is to be visited; what becomes of the
/// others is not asked
template <class IsWanted, class Visit>
void visit_placed_where(const CheckedScan& loaded, const MapRules& rules, bool flagged,
                        IsWanted&& is_wanted, Visit&& visit) {
  const Pose T_world_sensor = pose_of(loaded.scan, rules);
  const Eigen::Vector3d lift(0.0, 0.0, rules.options.lift);
  for (std::size_t i = 0; i < loaded.scan.size(); ++i) {
    if (loaded.removed(i) != flagged) continue;
    const Eigen::Vector3d point = loaded.scan.points[i].cast<double>();
    const Eigen::Vector3d placed = T_world_sensor * (point + lift);
    if (!is_wanted(placed)) continue;
    const std::uint32_t word = loaded.labels[i];
    if (fate_of(point, rules.classes.of(word), rules) != &PointCounts::evaluated) continue;
    visit(placed, word);
  }
}

/// The same for all points.
template <class Visit>
void visit_placed(const CheckedScan& loaded, const MapRules& rules, bool flagged, Visit&& visit) {
  const auto all = [](const Eigen::Vector3d&) { return true; };
  visit_placed_where(loaded, rules, flagged, all, std::forward<Visit>(visit));
}

/// The points of a scan that are evaluated and not flagged, world frame, lifted.
LabelledCloud place_scan(const CheckedScan& scan, const MapRules& rules);

/// What becomes of the points of a scan.
PointCounts count_points(const CheckedScan& scan, const MapRules& rules);

/// The dense map, point by point: the voxels of all scans, one scan after the other. For searches
/// of the nearest point however far away; a map of voxels needs none of it (see `TruthMap`).
/// @param task shown as progress
/// @throws DataError if a scan's labels do not fit it
LabelledCloud dense_map(const MapRules& rules, const std::string& task);

}  // namespace raymoval::erasor
