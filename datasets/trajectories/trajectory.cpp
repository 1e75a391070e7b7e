// SPDX-License-Identifier: MIT
#include "datasets/trajectories/trajectory.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

constexpr Nanoseconds kSecond = 1'000'000'000;
constexpr std::size_t kDecimals = 9;

bool all_digits(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

Nanoseconds from_seconds(double seconds) {
  return static_cast<Nanoseconds>(std::llround(seconds * static_cast<double>(kSecond)));
}

double to_seconds(Nanoseconds time) {
  // Whole seconds and the rest apart: each is exact, and only their sum is rounded.
  return static_cast<double>(time / kSecond) +
         static_cast<double>(time % kSecond) / static_cast<double>(kSecond);
}

std::optional<Nanoseconds> parse_stamp(std::string_view text) {
  const bool negative = text.starts_with('-');
  const std::string_view digits = negative || text.starts_with('+') ? text.substr(1) : text;
  const std::size_t point = digits.find('.');
  const std::string_view whole = digits.substr(0, point);
  const std::string_view part = point == std::string_view::npos ? "" : digits.substr(point + 1);
  if (!all_digits(whole) || !all_digits(part)) {
    // An exponent, or no number: a double has what digits such a number has.
    const auto number = parse_number<double>(text);
    if (!number || !(std::abs(*number) < 9.2e9)) return std::nullopt;
    return from_seconds(*number);
  }
  if (whole.empty() && part.empty()) return std::nullopt;
  const auto seconds =
      whole.empty() ? std::optional<Nanoseconds>(0) : parse_number<Nanoseconds>(whole);
  if (!seconds || *seconds > std::numeric_limits<Nanoseconds>::max() / kSecond - 1) {
    return std::nullopt;
  }
  std::string decimals(part.substr(0, kDecimals));
  decimals.resize(kDecimals, '0');
  const bool up = part.size() > kDecimals && part[kDecimals] >= '5';
  const Nanoseconds stamp =
      *seconds * kSecond + *parse_number<Nanoseconds>(decimals) + (up ? 1 : 0);
  return negative ? -stamp : stamp;
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

Pose interpolated(const Pose& a, const Pose& b, double t) {
  Pose pose = Pose::Identity();
  pose.translation() = (1.0 - t) * a.translation() + t * b.translation();
  const Eigen::Quaterniond from(a.linear()), to(b.linear());
  pose.linear() = from.slerp(t, to).normalized().toRotationMatrix();
  return pose;
}

}  // namespace raymoval
