// SPDX-License-Identifier: MIT
#include "datasets/bag_scans/chain_motion.h"

#include <algorithm>

namespace raymoval {

std::optional<Pose> ChainMotion::at(Nanoseconds stamp) const {
  Pose T_world_sensor = Pose::Identity();
  for (const ChainLink& link : links_) {
    std::optional<Pose> step = link.fixed;
    if (!link.moving.empty()) step = link.moving.at(stamp + time_offset_, max_gap_);
    if (!step) return std::nullopt;
    T_world_sensor = T_world_sensor * (link.inverse ? step->inverse() : *step);
  }
  return T_world_sensor;
}

std::pair<Nanoseconds, Nanoseconds> ChainMotion::span() const {
  // Without a moving step it is known at any time that a clock has.
  constexpr Nanoseconds kAnyTime = Nanoseconds{1} << 61;
  std::pair<Nanoseconds, Nanoseconds> span{-kAnyTime, kAnyTime};
  for (const ChainLink& link : links_) {
    if (link.moving.empty()) continue;
    span.first = std::max(span.first, link.moving.poses().front().stamp - time_offset_);
    span.second = std::min(span.second, link.moving.poses().back().stamp - time_offset_);
  }
  return span;
}

Trajectory ordered_trajectory(std::vector<StampedPose> poses) {
  std::stable_sort(poses.begin(), poses.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.stamp < b.stamp; });
  std::vector<StampedPose> ordered;
  for (const StampedPose& pose : poses) {
    if (!ordered.empty() && ordered.back().stamp == pose.stamp) ordered.pop_back();
    ordered.push_back(pose);
  }
  return Trajectory(std::move(ordered));
}

}  // namespace raymoval
