// SPDX-License-Identifier: MIT
#include "eval/erasor/maps/accumulate.h"

#include <algorithm>

#include "eval/erasor/frame.h"
#include "eval/scan_passes.h"

namespace raymoval::erasor {
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

Pose pose_of(const Scan& scan, const MapRules& rules) {
  return rules.options.frame == FrameOption::kErasor
             ? erasor_pose(scan.T_world_sensor, rules.input.T_camera_lidar.value())
             : scan.T_world_sensor;
}

LabelledCloud place_scan(const CheckedScan& scan, const MapRules& rules) {
  LabelledCloud cloud;
  cloud.points.reserve(scan.scan.size());
  cloud.labels.reserve(scan.scan.size());
  visit_placed(scan, rules, false, [&](const Eigen::Vector3d& point, std::uint32_t word) {
    cloud.points.push_back(point);
    cloud.labels.push_back(word);
  });
  return cloud;
}

PointCounts count_points(const CheckedScan& scan, const MapRules& rules) {
  PointCounts counts;
  for (std::size_t i = 0; i < scan.scan.size(); ++i) {
    const Eigen::Vector3d point = scan.scan.points[i].cast<double>();
    const auto fate = fate_of(point, rules.classes.of(scan.labels[i]), rules);
    ++(counts.*fate);
    if (fate != &PointCounts::evaluated) continue;
    counts.removed += scan.removed(i) ? 1 : 0;
    counts.trucks += semantic_id(scan.labels[i]) == kMovingTruck ? 1 : 0;
  }
  return counts;
}

LabelledCloud dense_map(const MapRules& rules, const std::string& task) {
  LabelledCloud dense;
  std::vector<LabelledCloud> slots(usual_slots(rules.input));
  in_scan_order(
      rules.input, task, slots.size(),
      [&](std::size_t scan, std::size_t slot) {
        const LabelledCloud placed = place_scan(load_checked(rules.input, nullptr, scan), rules);
        slots[slot] = voxelise(placed, rules.options.voxel_size, rules.classes, 1).cloud;
      },
      [&](std::size_t slot) { dense.append(slots[slot]); });
  return dense;
}

}  // namespace raymoval::erasor
