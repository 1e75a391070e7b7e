// SPDX-License-Identifier: MIT
#include "datasets/trajectories/trajectory.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/error.h"
#include "core/text.h"

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

namespace {

/// Scans without a pose, by the reason.
struct Missing {
  std::size_t before = 0, after = 0, in_gap = 0;

  [[nodiscard]] std::size_t all() const { return before + after + in_gap; }
  [[nodiscard]] std::string reasons() const {
    std::vector<std::string> parts;
    if (before > 0) parts.push_back(grouped_text(before) + " before the first pose");
    if (after > 0) parts.push_back(grouped_text(after) + " after the last pose");
    if (in_gap > 0) {
      parts.push_back(grouped_text(in_gap) + " between poses that are too far apart in time");
    }
    return join(parts);
  }
};

std::string range_text(Nanoseconds first, Nanoseconds last) {
  return stamp_text(first) + " s to " + stamp_text(last) + " s";
}

/// The remedy: a time offset if the ranges hardly overlap, a larger gap if most scans are in gaps.
std::string remedy(const std::vector<Nanoseconds>& stamps, const SensorMotion& motion,
                   const Missing& missing) {
  if (missing.in_gap > missing.before + missing.after) {
    return "Allow interpolation between poses that are further apart (--max-gap SECONDS), or take "
           "a trajectory with a pose for each scan.";
  }
  const auto [first, last] = std::minmax_element(stamps.begin(), stamps.end());
  const auto [begin, end] = motion.span();
  const Nanoseconds offset = begin + motion.time_offset() - *first;
  const bool overlap = *first <= end && begin <= *last;
  return (overlap ? std::string("Take the trajectory of the whole drive, or choose the scans that "
                                "it covers with --frames. If its clock is another one, ")
                  : std::string("Take the trajectory that belongs to these scans. If its clock is "
                                "another one, ")) +
         "--time-offset " + stamp_text(offset) + " lays the first scan on the first pose.";
}

}  // namespace

SensorMotion SensorMotion::followed_by(const std::vector<MotionStep>& steps) const {
  SensorMotion motion = *this;
  motion.steps_.insert(motion.steps_.end(), steps.begin(), steps.end());
  return motion;
}

std::optional<Pose> SensorMotion::at(Nanoseconds stamp) const {
  std::optional<Pose> T_world_sensor;
  for (const MotionStep& link : steps_) {
    std::optional<Pose> step =
        link.fixed ? link.fixed : link.moving.at(stamp + time_offset_, max_gap_);
    if (!step) return std::nullopt;
    if (link.inverse) step = step->inverse();
    T_world_sensor = T_world_sensor ? *T_world_sensor * *step : *step;
  }
  return T_world_sensor;
}

std::pair<Nanoseconds, Nanoseconds> SensorMotion::span() const {
  // Without a moving step, the pose is known at all times.
  constexpr Nanoseconds kAnyTime = Nanoseconds{1} << 61;
  std::pair<Nanoseconds, Nanoseconds> span{-kAnyTime, kAnyTime};
  for (const MotionStep& link : steps_) {
    if (link.fixed) continue;
    span.first = std::max(span.first, link.moving.poses().front().stamp - time_offset_);
    span.second = std::min(span.second, link.moving.poses().back().stamp - time_offset_);
  }
  return span;
}

FoundPoses look_up_poses(const std::vector<Nanoseconds>& stamps, const SensorMotion& motion,
                         const std::string& where) {
  const auto [begin, end] = motion.span();
  FoundPoses found;
  Missing missing;
  for (const Nanoseconds stamp : stamps) {
    found.poses.push_back(motion.at(stamp));
    if (found.poses.back()) continue;
    ++(stamp < begin ? missing.before : stamp > end ? missing.after : missing.in_gap);
  }
  found.missing = missing.all();
  if (found.missing == 0) return found;
  const std::string share = grouped_text(found.missing) + " of " +
                            counted_text(stamps.size(), "scan") +
                            " have no pose: " + missing.reasons();
  if (4 * found.missing >= stamps.size()) {
    const auto [first, last] = std::minmax_element(stamps.begin(), stamps.end());
    found.gap = {where,
                 share + ". The scans are from " + range_text(*first, *last) + ", the poses from " +
                     range_text(begin, end) +
                     (motion.time_offset() == 0 ? "" : " on the clock of the scans"),
                 remedy(stamps, motion, missing)};
  }
  if (2 * found.missing >= stamps.size()) throw PosesMissing(*found.gap);
  found.losses.push_back(where + ": " + share + ". They are left out.");
  return found;
}

}  // namespace raymoval
