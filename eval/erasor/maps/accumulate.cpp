// SPDX-License-Identifier: MIT
#include "eval/erasor/maps/accumulate.h"

#include <algorithm>

#include "eval/erasor/frame.h"
#include "eval/scan_passes.h"

namespace raymoval::erasor {
namespace {

/// Which of the counts a point belongs to.
std::int64_t PointCounts::*fate_of(const Eigen::Vector3d& point, LabelClass label_class,
                                   const EvaluationInput& input, const Options& options) {
  if (!input.range_m.contains(point.norm())) return &PointCounts::out_of_range;
  if (label_class == LabelClass::kIgnored) return &PointCounts::ignored;
  const double limit = options.minimum_horizontal_range;
  const double horizontal_squared = point.x() * point.x() + point.y() * point.y();
  return horizontal_squared < limit * limit ? &PointCounts::cropped : &PointCounts::evaluated;
}

/// World pose of a scan in the frame that the options want.
Pose pose_of(const Scan& scan, const EvaluationInput& input, const Options& options) {
  return options.frame == FrameOption::kErasor
             ? erasor_pose(scan.T_world_sensor, input.T_camera_lidar.value())
             : scan.T_world_sensor;
}

/// The evaluated points that are flagged, or those that are not.
PlacedScan place_points(const CheckedScan& loaded, const MapRules& rules, bool flagged) {
  const Scan& scan = loaded.scan;
  const std::vector<std::uint32_t>& labels = loaded.labels;
  const Pose T_world_sensor = pose_of(scan, rules.input, rules.options);
  PlacedScan placed;
  if (!flagged) {
    placed.cloud.points.reserve(scan.size());
    placed.cloud.labels.reserve(scan.size());
  }
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Eigen::Vector3d point = scan.points[i].cast<double>();
    const auto fate = fate_of(point, rules.classes.of(labels[i]), rules.input, rules.options);
    ++(placed.points.*fate);
    if (fate != &PointCounts::evaluated) continue;
    if (semantic_id(labels[i]) == kMovingTruck) ++placed.points.trucks;
    placed.points.removed += loaded.removed(i) ? 1 : 0;
    if (loaded.removed(i) != flagged) continue;
    const Eigen::Vector3d lifted = point + Eigen::Vector3d(0.0, 0.0, rules.options.lift);
    placed.cloud.points.push_back(T_world_sensor * lifted);
    placed.cloud.labels.push_back(labels[i]);
  }
  return placed;
}

}  // namespace

PointCounts& PointCounts::operator+=(const PointCounts& other) {
  out_of_range += other.out_of_range;
  ignored += other.ignored;
  cropped += other.cropped;
  evaluated += other.evaluated;
  removed += other.removed;
  trucks += other.trucks;
  return *this;
}

LabelRule effective_rule(const LabelRule& rule, const Options& options) {
  LabelRule effective = rule;
  if (!options.truck_is_moving) std::erase(effective.moving, kMovingTruck);
  return effective;
}

PlacedScan place_scan(const CheckedScan& scan, const MapRules& rules) {
  return place_points(scan, rules, false);
}

PlacedScan place_flagged(const CheckedScan& scan, const MapRules& rules) {
  return place_points(scan, rules, true);
}

LabelledCloud dense_map(const MapRules& rules, const std::string& task) {
  LabelledCloud dense;
  std::vector<LabelledCloud> slots(usual_slots(rules.input));
  in_scan_order(
      rules.input, task, slots.size(),
      [&](std::size_t scan, std::size_t slot) {
        const PlacedScan placed = place_scan(load_checked(rules.input, nullptr, scan), rules);
        slots[slot] = voxelise(placed.cloud, rules.options.voxel_size, rules.classes, 1).cloud;
      },
      [&](std::size_t slot) { dense.append(slots[slot]); });
  return dense;
}

}  // namespace raymoval::erasor
