// SPDX-License-Identifier: MIT
#include "eval/erasor/maps/accumulate.h"

#include <algorithm>

#include "eval/scan_passes.h"

namespace raymoval::erasor {
namespace {

Pose make_fixed_calibration() {
  Pose pose = Pose::Identity();
  pose.linear() << -1.857739385241e-03, -9.999659513510e-01, -8.039975204516e-03,  //
      -6.481465826011e-03, 8.051860151134e-03, -9.999466081774e-01,                //
      9.999773098287e-01, -1.805528627661e-03, -6.496203536139e-03;
  pose.translation() << -4.784029760483e-03, -7.337429464231e-02, -3.339968064433e-01;
  return pose;
}

/// Camera axes (right, down, forward) to forward, left, up.
Pose make_axes() {
  Pose pose = Pose::Identity();
  pose.linear() << 0.0, 0.0, 1.0,  //
      -1.0, 0.0, 0.0,              //
      0.0, -1.0, 0.0;
  return pose;
}

}  // namespace

const Pose& fixed_calibration() {
  static const Pose pose = make_fixed_calibration();
  return pose;
}

Pose erasor_pose(const Pose& T_world_sensor, const Pose& T_camera_lidar) {
  static const Pose axes = make_axes();
  const Pose camera_pose = T_camera_lidar * T_world_sensor * T_camera_lidar.inverse();
  return axes * camera_pose * fixed_calibration();
}

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
