// SPDX-License-Identifier: MIT
#include "datasets/trajectories/trajectory.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "core/error.h"

namespace raymoval {
namespace {

constexpr Nanoseconds kSecond = 1'000'000'000;
constexpr std::size_t kDecimals = 9;

}  // namespace

Nanoseconds from_seconds(double seconds) {
  return static_cast<Nanoseconds>(std::llround(seconds * static_cast<double>(kSecond)));
}

double to_seconds(Nanoseconds time) {
  constexpr Nanoseconds kExact = 1LL << 53;  // Up to here (104 days) a double holds each of them.
  if (std::abs(time) <= kExact) return static_cast<double>(time) / static_cast<double>(kSecond);
  // Whole seconds and the rest apart: each is exact, and only their sum is rounded.
  return static_cast<double>(time / kSecond) +
         static_cast<double>(time % kSecond) / static_cast<double>(kSecond);
}

std::string stamp_text(Nanoseconds stamp) {
  std::string part = std::to_string(std::abs(stamp % kSecond));
  part.insert(0, kDecimals - part.size(), '0');
  return (stamp < 0 ? "-" : "") + std::to_string(std::abs(stamp / kSecond)) + "." + part;
}

Trajectory::Trajectory(std::vector<StampedPose> poses) : poses_(std::move(poses)) {
  for (std::size_t i = 1; i < poses_.size(); ++i) {
    if (poses_[i].stamp > poses_[i - 1].stamp) continue;
    throw InternalError("the poses of a trajectory are not in order of time");
  }
}

std::optional<Pose> Trajectory::at(Nanoseconds stamp, Nanoseconds max_gap) const {
  const auto after =
      std::lower_bound(poses_.begin(), poses_.end(), stamp,
                       [](const StampedPose& pose, Nanoseconds time) { return pose.stamp < time; });
  if (after == poses_.end()) return std::nullopt;
  if (after->stamp == stamp) return after->T_world_body;
  if (after == poses_.begin()) return std::nullopt;
  const StampedPose& before = *(after - 1);
  if (after->stamp - before.stamp > max_gap) return std::nullopt;
  const double share =
      static_cast<double>(stamp - before.stamp) / static_cast<double>(after->stamp - before.stamp);
  return interpolated(before.T_world_body, after->T_world_body, share);
}

std::optional<Nanoseconds> Trajectory::gap_at(Nanoseconds stamp) const {
  const auto after =
      std::lower_bound(poses_.begin(), poses_.end(), stamp,
                       [](const StampedPose& pose, Nanoseconds time) { return pose.stamp < time; });
  if (after == poses_.end()) return std::nullopt;
  if (after->stamp == stamp) return 0;
  if (after == poses_.begin()) return std::nullopt;
  return after->stamp - (after - 1)->stamp;
}

Pose part_of(const Pose& motion, double part) {
  const Eigen::AngleAxisd turn(motion.linear());
  Pose result = Pose::Identity();
  result.linear() = Eigen::AngleAxisd(part * turn.angle(), turn.axis()).toRotationMatrix();
  result.translation() = part * motion.translation();
  return result;
}

Pose interpolated(const Pose& a, const Pose& b, double t) {
  Pose pose = Pose::Identity();
  pose.translation() = (1.0 - t) * a.translation() + t * b.translation();
  const Eigen::Quaterniond from(a.linear()), to(b.linear());
  pose.linear() = from.slerp(t, to).normalized().toRotationMatrix();
  return pose;
}

}  // namespace raymoval
