// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/sampling.h"
#include "core/text.h"
#include "datasets/inspection/checks/checks.h"
#include "datasets/inspection/evidence/pose_fit.h"
#include "datasets/inspection/evidence/time_offset.h"

namespace raymoval::inspection {
namespace {

std::string between(const Samples& samples, std::size_t scan) {
  return "frames " + samples.frame_name(scan) + " to " + samples.frame_name(scan + 1);
}

std::string and_more(std::size_t count) {
  return count > 1 ? ", and " + grouped_text(count - 1) + " more like it" : "";
}

std::vector<double> periods(const Samples& samples) {
  std::vector<double> all;
  for (std::size_t i = 1; i < samples.files().size(); ++i) {
    all.push_back(samples.files()[i].time_s - samples.files()[i - 1].time_s);
  }
  return all;
}

std::vector<Finding> look_for_gaps(Samples& samples) {
  constexpr double kGap = 1.6;
  const std::vector<double> all = periods(samples);
  if (all.size() < 2) return {};
  const double usual = median(all);
  std::vector<std::size_t> gaps, still;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i] > kGap * usual) gaps.push_back(i);
    if (all[i] <= 0.0) still.push_back(i);
  }
  std::vector<Finding> findings;
  if (!still.empty()) {
    findings.push_back({.where = between(samples, still.front()),
                        .what = "the time does not advance" + and_more(still.size()),
                        .remedy = "Give each scan its own time, or leave times.txt out."});
  }
  if (!gaps.empty() && usual > 0.0) {
    findings.push_back(
        {.where = between(samples, gaps.front()),
         .what = fmt::format("{} s pass, where {} s are usual{}", fixed_text(all[gaps.front()], 3),
                             fixed_text(usual, 3), and_more(gaps.size()))});
  }
  return findings;
}

/// Finds scans that were left out and renumbered: only the motion shows them.
std::vector<Finding> look_for_jumps(Samples& samples) {
  constexpr double kJump = 1.7, kSlack = 0.3;
  if (!pose_verdict(samples).check.empty()) return {};
  const auto& poses = samples.poses();
  std::vector<double> steps;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const auto& files = samples.files();
    const double time = files.empty() ? 1.0 : files[i].time_s - files[i - 1].time_s;
    const double first = files.empty() ? 1.0 : files[1].time_s - files[0].time_s;
    const double step = (poses[i].translation() - poses[i - 1].translation()).norm();
    steps.push_back(time > 0.0 && first > 0.0 ? step / time * first : step);
  }
  std::vector<std::size_t> jumps;
  for (std::size_t i = 1; i + 1 < steps.size(); ++i) {
    if (steps[i] > kJump * std::max(steps[i - 1], steps[i + 1]) + kSlack) jumps.push_back(i);
  }
  if (jumps.empty()) return {};
  const std::size_t at = jumps.front();
  return {{.where = samples.pose_source() + ", " + between(samples, at),
           .what = fmt::format("the sensor moves {} m, but {} m and {} m before and after{}",
                               fixed_text(steps[at], 2), fixed_text(steps[at - 1], 2),
                               fixed_text(steps[at + 1], 2), and_more(jumps.size()))}};
}

/// For poses that are nearly right; findings of `pose_verdict` come first. If poses do not fit,
/// `fit_checks` report the offset, because the map would be wrong.
std::vector<Finding> look_for_time_offset(Samples& samples) {
  if (!pose_verdict(samples).check.empty() || !fits(measured_fit(samples))) return {};
  const std::optional<TimeOffset> offset = find_time_offset(samples);
  if (!offset || !is_clear(*offset)) return {};
  return {{.what = time_offset_text(*offset),
           .remedy = "Use " + time_offset_option(samples, *offset) + "."}};
}

std::vector<Finding> look_for_missing_poses(Samples& samples) {
  const std::optional<PoseGap>& gap = samples.sequence().pose_gap;
  if (!gap) return {};
  return {{.where = gap->where, .what = gap->what, .remedy = gap->remedy}};
}

}  // namespace

std::vector<Check> time_checks() {
  return {
      {kMissingPoses, "a quarter of the scans or more have no pose, often because clocks differ",
       "a pose for each scan",
       "Take the trajectory of the whole drive, or use --time-offset if its clock is another one.",
       look_for_missing_poses},
      {"time-offset", "the clocks of scans and poses differ", "scans and poses on one clock",
       "Use --time-offset with the time of poses minus that of scans.", look_for_time_offset},
      {"gap-in-time", "scans are missing in between", "one scan a period",
       "Add the missing scans, or choose frames without the gap (--frames).", look_for_gaps},
      {"jump-in-motion", "scans were left out and the rest renumbered, or a pose is wrong",
       "a speed that changes little from scan to scan",
       "Put the missing scans back, or repair the pose.", look_for_jumps},
  };
}

namespace {

Check verdict_check(const std::string& name, const std::string& finds, const std::string& expected,
                    const std::string& remedy) {
  const auto look = [name](Samples& samples) {
    const PoseVerdict& verdict = pose_verdict(samples);
    if (verdict.check != name) return std::vector<Finding>();
    return std::vector<Finding>{{.what = verdict.what, .remedy = verdict.remedy}};
  };
  return {name, finds, expected, remedy, look, Consequence::kRefused};
}

/// Number of points right below `centre`, where a sensor has its blind zone.
std::size_t points_below(const Scan& scan, const Eigen::Vector3d& centre) {
  std::size_t count = 0;
  for (const Eigen::Vector3f& point : scan.points) {
    const Eigen::Vector3d offset = scan.T_world_sensor * point.cast<double>() - centre;
    if (offset.head<2>().norm() < 1.0 && offset.z() < -0.5) ++count;
  }
  return count;
}

constexpr const char* kWriteViewpoint =
    "Write the position and attitude of the sensor at each scan into its VIEWPOINT; points in the "
    "world frame do not contain the position of the sensor.";

/// Checks VIEWPOINT for points in the world frame, which agree with any VIEWPOINT: there must be no
/// ground right below the sensor.
std::vector<Finding> look_for_sensor(Samples& samples) {
  constexpr std::size_t kMany = 8, kFew = 2;
  if (!samples.points_in_world() || !pose_verdict(samples).check.empty()) return {};
  if (has_one_viewpoint(samples)) {
    return {{.check = "viewpoint-missing",
             .what = "VIEWPOINT is the same in all files, but the points move from scan to scan",
             .remedy = kWriteViewpoint}};
  }
  std::size_t given = 0, inverse = 0;
  for (const auto& [index, scan] : samples.scans()) {
    if (points_below(scan, scan.T_world_sensor.translation()) >= kMany) ++given;
    const std::size_t below = points_below(scan, scan.T_world_sensor.inverse().translation());
    if (below <= kFew) ++inverse;
  }
  const std::size_t count = samples.scans().size();
  if (2 * given <= count) return {};
  Finding finding;
  finding.check = 10 * inverse >= 9 * count ? "poses-inverted" : "viewpoint-missing";
  finding.what = grouped_text(given) + " of " + grouped_text(count) +
                 " scans have points right below the position that VIEWPOINT gives, where no " +
                 "sensor sees the ground";
  if (finding.check == "poses-inverted") {
    finding.what += "; below the position of the inverse pose there are none";
    finding.remedy =
        "Write the pose of the sensor in the world (T_world_sensor) into VIEWPOINT, "
        "not its inverse.";
  } else {
    finding.remedy = kWriteViewpoint;
  }
  return {finding};
}

}  // namespace

std::vector<Check> pose_checks() {
  const std::string agree = "scans that lie on each other under T_world_sensor of each";
  return {
      verdict_check("poses-inverted",
                    "poses transform from the world to the sensor (T_sensor_world)", agree,
                    "Invert each pose: R^T and -R^T t. For a pose file, --pose-format inverse does "
                    "that."),
      verdict_check("camera-frame", "poses or points are in camera axes, not in the LiDAR's",
                    "LiDAR axes: x ahead, y left, z up, in points and poses alike",
                    "Poses of a camera: transform them to the LiDAR with T = Tr^-1 P Tr (in "
                    "SemanticKITTI layout put 'Tr:' into calib.txt and leave \"poses_are_lidar\" "
                    "out; elsewhere use --T-sensor with the pose of the LiDAR in the camera's "
                    "frame). Points in a camera frame: transform them to the LiDAR with Tr^-1."),
      verdict_check("lidar-poses-as-camera",
                    "poses of the LiDAR are read as those of a camera (or the points, not the "
                    "poses, are in camera axes)",
                    "camera poses beside a calib.txt with 'Tr:'",
                    "Set \"poses_are_lidar\": true in sequence.json."),
      verdict_check("quaternion-order", "quaternions have their numbers in another order",
                    "TUM rows: t x y z qx qy qz qw; VIEWPOINT: tx ty tz qw qx qy qz",
                    "For a pose file use --pose-format euroc if w is the first of the four "
                    "numbers, or --pose-format tum if it is the last. Else reorder the columns."),
      verdict_check("poses-in-millimetres",
                    "positions of the poses are in millimetres or centimetres", "metres",
                    "Divide the positions by 1,000 if they are millimetres, or by 100 if they are "
                    "centimetres."),
      verdict_check("poses-coarse", "positions far from the origin have too few digits",
                    "positions to the millimetre",
                    "Write positions with all their digits (in C++ std::setprecision(12)), or "
                    "shift them to an origin near by."),
      verdict_check("viewpoint-twice", "VIEWPOINT is applied to the stored points twice",
                    "stored points = T p with T from VIEWPOINT and p in the sensor frame",
                    "Apply VIEWPOINT once when writing the points."),
      verdict_check("viewpoint-missing",
                    "VIEWPOINT is not applied to the stored points, or is not "
                    "the pose of the sensor",
                    "stored points = T p with T from VIEWPOINT and p in the sensor frame",
                    "Use --points sensor if the points are in the frame of the sensor."),
      {"sensor-elsewhere", "VIEWPOINT is not the position of the sensor",
       "VIEWPOINT = tx ty tz qw qx qy qz, the pose of the sensor",
       "Write the pose of the sensor at each scan into its VIEWPOINT.", look_for_sensor,
       Consequence::kRefused},
      verdict_check("points-in-world", "points are in the world frame although there are poses",
                    "points in the frame of the sensor", "Use --points world."),
      verdict_check(
          "poses-shifted", "poses are those of the scan before or after", agree,
          "Shift the rows of the pose file by one, so that row N belongs to scan N. If poses and "
          "scans have times, use --time-offset with the time of a scan, or its negative."),
      verdict_check(
          "poses-of-a-body", "poses are those of a body, and the sensor is rotated on it", agree,
          "Give the pose of the sensor on the body (--T-sensor), or correct 'Tr' in calib.txt."),
      verdict_check("poses-of-another-time", "the clocks of scans and poses differ by much", agree,
                    "Use --time-offset with the time of poses minus that of scans."),
      verdict_check("poses-of-another-sequence", "poses do not belong to these scans", agree,
                    "Take the pose file that belongs to these scans (--poses FILE). If its poses "
                    "are those of a body that carries the sensor, give the pose of the sensor on "
                    "it (--T-sensor). If its clock is another one, use --time-offset."),
  };
}

}  // namespace raymoval::inspection
