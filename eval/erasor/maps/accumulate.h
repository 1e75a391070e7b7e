// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/scan/scan.h"
#include "eval/checked_scan.h"
#include "eval/erasor/maps/map_voxels.h"
#include "eval/erasor/options.h"
#include "eval/points/labelled_voxels.h"
#include "eval/protocol.h"

namespace raymoval::erasor {

/// The pose of a scan in ERASOR's map tool: `A P Tr_fixed`, with P the camera pose of the data set,
/// A the rotation of camera axes to forward, left, up, and Tr_fixed one calibration for all
/// sequences, that of SemanticKITTI 04 to 12. If `T_camera_lidar` is this calibration, all scans
/// move by one rigid motion. Else scans are also displaced relative to each other (sequences 00 to
/// 02: 0.137 degrees and 5 cm).
/// @param T_world_sensor pose in the sequence's frame, Tr^-1 P Tr
/// @param T_camera_lidar the sequence's own calibration Tr
/// Source: ERASOR, public code, `kitti2node.py`.
Pose erasor_pose(const Pose& T_world_sensor, const Pose& T_camera_lidar);

/// Tr_fixed.
const Pose& fixed_calibration();

/// Counts of the points of all scans. The first four counts add up to the points that were
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

/// The label rule with the options applied: id 258 moves only with `truck_is_moving`.
LabelRule effective_rule(const LabelRule& rule, const Options& options);

/// The inputs of a map. All parts must outlive the map.
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

/// World pose of a scan in the frame of the options.
Pose pose_of(const Scan& scan, const MapRules& rules);

/// Steps 1 to 3 of the ground truth for one scan: crop, lift in the sensor frame, pose. Calls
/// `visit(point, label)` for each evaluated point, flagged or not as requested. @param is_wanted
/// whether a point of the world frame is visited; the others are skipped early
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

/// The outcome of each point of a scan.
PointCounts count_points(const CheckedScan& scan, const MapRules& rules);

/// The dense map, point by point: the voxels of all scans, one scan after the other. For searches
/// of the nearest point at any distance; a map of voxels does not need it (see `TruthMap`).
/// @param task shown as progress
/// @throws DataError if a scan's labels do not fit it
LabelledCloud dense_map(const MapRules& rules, const std::string& task);

}  // namespace raymoval::erasor
