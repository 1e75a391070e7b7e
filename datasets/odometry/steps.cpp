// SPDX-License-Identifier: MIT
#include "datasets/odometry/steps.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/parallel.h"
#include "core/text.h"
#include "datasets/odometry/odometry.h"
#include "datasets/trajectories/trajectory.h"

namespace raymoval::odometry {
namespace {

/// Of a scan that overlaps with the scans before it; scans of good estimates reach 0.16.
constexpr double kLeastFit = 0.1;
constexpr std::size_t kScansAtOnce = 8;
constexpr std::size_t kFirstScans = 4, kScansAfter = 10;  // Registered again; in their map.
constexpr double kStartReach = 0.5;                       // metres

[[noreturn]] void throw_lost(const Steps& steps) {
  const std::size_t now = steps.scans.size() - 1;
  const double apart = steps.times[now] - steps.times[now - 1];
  const std::string gap = apart < kLongGap ? ""
                                           : " It was taken " + fixed_text(apart, 1) +
                                                 " s after scan " + steps.names[now - 1] + ".";
  throw DataError(fmt::format(
      "scan {}: does not overlap enough with the scans before it to estimate its pose: {} of its "
      "points lie on their surfaces (expected at least {}).{} Estimate the scans before and after "
      "it by themselves (--frames), or take the poses of a program that also uses an IMU: --poses "
      "FILE.",
      steps.names[now], percent_text(steps.scans[now].fit()), percent_text(kLeastFit), gap));
}

/// The pose of scan `i` if the motion from it to the next was as the one after.
Pose predicted_back(const std::vector<Pose>& poses, const std::vector<double>& times,
                    std::size_t i) {
  const double now = times[i + 1] - times[i], after = times[i + 2] - times[i + 1];
  const double part = now > 0.0 && after > 0.0 ? now / after : 1.0;
  return poses[i + 1] * part_of(poses[i + 1].inverse() * poses[i + 2], part).inverse();
}

/// Registers the first scans again, the later first, to the scans after them, also from a guess.
void register_start(const MovingScans& input, Steps& steps) {
  const std::size_t count = std::min(steps.scans.size(), kFirstScans + kScansAfter);
  const std::size_t first = std::min(kFirstScans, count / 2);
  if (first < 2) return;
  std::vector<Pose> poses = steps.poses();
  PlaneMap map(input.scale.cell);
  for (std::size_t i = first; i < count; ++i) {
    map.add(thinned(input, poses, steps.times, i).dense, poses[i]);
  }
  for (std::size_t i = first; i-- > 0;) {
    const ThinnedScan thin = thinned(input, poses, steps.times, i);
    Registered best = register_to_map(map, thin.sparse, poses[i], kLeastReach);
    const Registered other =
        register_to_map(map, thin.sparse, predicted_back(poses, steps.times, i), kStartReach);
    if (other.fit() > best.fit()) best = other;
    if (is_lost(best)) break;
    poses[i] = best.T_map_sensor;
    steps.scans[i + 1].determined &= best.determined;
    map.add(thin.dense, poses[i]);
  }
  const Pose T_first_map = poses[0].inverse();
  for (std::size_t i = 0; i < steps.scans.size(); ++i) {
    steps.scans[i].T_map_sensor = T_first_map * poses[i];
  }
  steps.scans[0].T_map_sensor = Pose::Identity();
}

}  // namespace

ThinnedScan thinned(const MovingScans& input, const std::vector<Pose>& poses,
                    const std::vector<double>& times, std::size_t i) {
  throw_if_cancelled(input.cancel);
  const Scan scan = input.scans.load(i);
  ScanMotion motion;
  if (input.point_times && poses.size() > 1) {
    const std::size_t before = i == 0 ? 0 : i - 1;
    motion = {input.point_times(scan), poses[before].inverse() * poses[before + 1],
              times[before + 1] - times[before]};
  }
  return thinned(scan, motion, input.scale);
}

bool is_lost(const Registered& scan) {
  return scan.fit() < kLeastFit;
}

Steps odometry_of(const MovingScans& input, const Course& course, const std::vector<Pose>* given) {
  Odometry odometry(input.scale, course.first_motion);
  Steps steps;
  const std::size_t count = course.scans;
  if (input.progress != nullptr) input.progress->begin("estimating poses", count);
  std::vector<Scan> scans;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % kScansAtOnce == 0) {
      scans.assign(std::min(kScansAtOnce, count - i), {});
      parallel_for(input.threads, scans.size(), 1,
                   [&](std::size_t k) { scans[k] = input.scans.load(i + k); });
    }
    throw_if_cancelled(input.cancel);
    const Scan& scan = scans[i % kScansAtOnce];
    std::optional<Pose> hint;
    if (given != nullptr && i > 0) hint = (*given)[i - 1].inverse() * (*given)[i];
    steps.times.push_back(scan.time_s);
    steps.names.push_back(scan.name);
    steps.scans.push_back(odometry.add(
        scan, input.point_times ? input.point_times(scan) : std::vector<double>(), hint));
    if (!course.may_be_lost && is_lost(steps.scans.back())) throw_lost(steps);
    if (input.progress != nullptr) input.progress->advance();
  }
  if (input.progress != nullptr) input.progress->end();
  register_start(input, steps);
  return steps;
}

}  // namespace raymoval::odometry
