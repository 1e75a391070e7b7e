// SPDX-License-Identifier: MIT
#include "eval/erasor/accumulate.h"

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

std::uint32_t DenseMap::scan_of(std::uint32_t point) const {
  const auto end = std::upper_bound(scan_ends.begin(), scan_ends.end(), std::size_t{point});
  return static_cast<std::uint32_t>(end - scan_ends.begin());
}

LabelRule effective_rule(const LabelRule& rule, const Options& options) {
  LabelRule effective = rule;
  if (!options.truck_is_moving) std::erase(effective.moving, kMovingTruck);
  return effective;
}

PlacedScan place_scan(const CheckedScan& loaded, const EvaluationInput& input,
                      const Options& options, const LabelClasses& classes) {
  const Scan& scan = loaded.scan;
  const std::vector<std::uint32_t>& labels = loaded.labels;
  const Pose T_world_sensor = pose_of(scan, input, options);
  PlacedScan placed;
  placed.cloud.points.reserve(scan.size());
  placed.cloud.labels.reserve(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Eigen::Vector3d point = scan.points[i].cast<double>();
    const auto fate = fate_of(point, classes.of(labels[i]), input, options);
    ++(placed.points.*fate);
    if (fate != &PointCounts::evaluated) continue;
    if (semantic_id(labels[i]) == kMovingTruck) ++placed.points.trucks;
    if (loaded.removed(i)) {
      ++placed.points.removed;
      continue;
    }
    const Eigen::Vector3d lifted = point + Eigen::Vector3d(0.0, 0.0, options.lift);
    placed.cloud.points.push_back(T_world_sensor * lifted);
    placed.cloud.labels.push_back(labels[i]);
  }
  return placed;
}

DenseScan dense_scan(const CheckedScan& scan, const EvaluationInput& input, const Options& options,
                     const LabelClasses& classes) {
  const PlacedScan placed = place_scan(scan, input, options, classes);
  return {voxelise(placed.cloud, options.voxel_size, classes, 1), placed.points};
}

void append(const DenseScan& scan, DenseMap& dense) {
  dense.cloud.append(scan.voxels.cloud);
  dense.mixed_label_ties += scan.voxels.mixed_label_ties;
  dense.points += scan.points;
  dense.scan_ends.push_back(dense.cloud.size());
}

DenseMap accumulate(const EvaluationInput& input, const Options& options,
                    const LabelClasses& classes, const std::string& task) {
  DenseMap dense;
  std::vector<DenseScan> slots(usual_slots(input));
  in_scan_order(
      input, task, slots.size(),
      [&](std::size_t scan, std::size_t slot) {
        slots[slot] = dense_scan(load_checked(input, nullptr, scan), input, options, classes);
      },
      [&](std::size_t slot) { append(slots[slot], dense); });
  return dense;
}

}  // namespace raymoval::erasor
