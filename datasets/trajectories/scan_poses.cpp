// SPDX-License-Identifier: MIT
#include "datasets/trajectories/scan_poses.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

/// `settings` without what is not true of a file of this program.
PoseSettings settings_for(const PoseFile& file, PoseSettings settings) {
  if (!file.of_sensor) return settings;
  settings.T_body_sensor.reset();
  settings.T_camera_lidar.reset();
  return settings;
}

/// The pose of the sensor on the body.
Pose mounting(const PoseSettings& settings) {
  if (settings.T_camera_lidar) return *settings.T_camera_lidar;
  return settings.T_body_sensor.value_or(Pose::Identity());
}

/// The pose of the body from a pose in the file, in a world with the axes of the sensor.
Pose body_pose(const Pose& pose, const PoseSettings& settings) {
  return settings.T_camera_lidar ? settings.T_camera_lidar->inverse() * pose : pose;
}

/// The pose of the sensor from a pose in the file.
Pose sensor_pose(const Pose& pose, const PoseSettings& settings) {
  if (!settings.T_camera_lidar && !settings.T_body_sensor) return pose;
  return body_pose(pose, settings) * mounting(settings);
}

/// Times of scans without times: the times of the rows, or assumed times.
std::vector<Nanoseconds> assumed_stamps(const ScanKeys& scans, const PoseFile* file) {
  if (!scans.stamps.empty()) return scans.stamps;
  std::vector<Nanoseconds> stamps;
  const bool stamped = file != nullptr && file->stamped();
  for (std::size_t i = 0; i < scans.rows.size(); ++i) {
    stamps.push_back(stamped ? *file->rows[scans.rows[i]].stamp : from_seconds(scans.times_s[i]));
  }
  return stamps;
}

void refuse_offset(const PoseSettings& settings, const std::string& why) {
  if (settings.time_offset == 0) return;
  throw UsageError("--time-offset has no effect here: " + why + ". Leave it out.");
}

ScanPoses by_time(const PoseFile& file, const ScanKeys& scans, const PoseSettings& settings) {
  ScanPoses result;
  result.stamps = scans.stamps;
  std::vector<StampedPose> poses = stamped_poses(file, result.notes);
  for (StampedPose& pose : poses) pose.T_world_body = body_pose(pose.T_world_body, settings);
  // The body moves on a straight line between poses; a sensor beside its centre does not.
  std::vector<MotionStep> steps(2);
  steps[0].moving = Trajectory(std::move(poses));
  steps[1].fixed = mounting(settings);
  result.motion =
      std::make_shared<SensorMotion>(std::move(steps), settings.time_offset, settings.max_gap);
  FoundPoses found = look_up_poses(scans.stamps, *result.motion, file.path.string());
  result.poses = std::move(found.poses);
  result.losses = std::move(found.losses);
  result.gap = std::move(found.gap);
  return result;
}

/// Reports the number of scans without a pose. @throws PosesMissing if it is half of them or more
void report_missing(const PoseFile& file, const std::string& why, const std::string& remedy,
                    ScanPoses& result) {
  const auto missing =
      static_cast<std::size_t>(std::count(result.poses.begin(), result.poses.end(), std::nullopt));
  if (missing == 0) return;
  const PoseGap gap{file.path.string(),
                    grouped_text(missing) + " of " + counted_text(result.poses.size(), "scan") +
                        " have no pose: " + why,
                    remedy};
  if (2 * missing >= result.poses.size()) throw PosesMissing(gap);
  if (4 * missing >= result.poses.size()) result.gap = gap;
  result.losses.push_back(gap.where + ": " + gap.what + ". They are left out.");
}

ScanPoses by_row(const PoseFile& file, const ScanKeys& scans, const PoseSettings& settings) {
  refuse_offset(settings, file.stamped() ? "the scans have no times of their own"
                                         : "the poses have no times");
  ScanPoses result;
  for (const std::size_t row : scans.rows) {
    result.poses.emplace_back();
    if (file.rows[row].has_pose()) {
      result.poses.back() = sensor_pose(rigid_pose(file, row), settings);
    }
  }
  report_missing(file, "their rows hold nan or zeros",
                 "Take a trajectory with a pose for each scan.", result);
  result.stamps = assumed_stamps(scans, &file);
  if (file.stamped() && scans.stamps.empty()) {
    const Nanoseconds first = *file.rows.front().stamp;
    for (const Nanoseconds stamp : result.stamps) {
      result.times_s.push_back(to_seconds(stamp - first));
    }
  }
  result.motion = motion_along(result.stamps, result.poses);
  return result;
}

/// Looks up poses by frame number.
ScanPoses by_frame(const PoseFile& file, const ScanKeys& scans, const PoseSettings& settings) {
  refuse_offset(settings, "the poses have no times");
  std::map<long, std::size_t> rows;
  for (std::size_t i = 0; i < file.rows.size(); ++i) rows.emplace(*file.rows[i].frame, i);
  ScanPoses result;
  for (std::size_t i = 0; i < scans.rows.size(); ++i) {
    const long frame = scans.frames.empty() ? static_cast<long>(scans.rows[i]) : scans.frames[i];
    const auto row = rows.find(frame);
    result.poses.emplace_back();
    if (row != rows.end() && file.rows[row->second].has_pose()) {
      result.poses.back() = sensor_pose(rigid_pose(file, row->second), settings);
    }
  }
  report_missing(
      file,
      "the file has those of " + counted_text(rows.size(), "frame") + " from " +
          std::to_string(rows.begin()->first) + " to " + std::to_string(rows.rbegin()->first),
      "Take the file that belongs to these scans, whose names are frame numbers.", result);
  result.stamps = assumed_stamps(scans, nullptr);
  result.motion = motion_along(result.stamps, result.poses);
  return result;
}

ScanPoses one_for_all(const Pose& pose, const ScanKeys& scans) {
  ScanPoses result;
  result.poses.assign(scans.rows.size(), pose);
  result.stamps = assumed_stamps(scans, nullptr);
  result.motion = motion_along(result.stamps, result.poses);
  return result;
}

/// `file` with the first row of each time only.
PoseFile without_repeats(PoseFile file) {
  const auto same = [](const PoseFile::Row& a, const PoseFile::Row& b) {
    return a.stamp && a.stamp == b.stamp;
  };
  file.rows.erase(std::unique(file.rows.begin(), file.rows.end(), same), file.rows.end());
  return file;
}

[[noreturn]] void throw_rows(const PoseFile& file, const ScanKeys& scans) {
  const std::string remedy =
      file.stamped() ? " The poses have times, but the scans have none: give the scans theirs in "
                       "times.txt (a time a line), or name their files by time."
                     : " Take the file that belongs to these scans.";
  throw DataError(file.path.string() + ": holds " + grouped_text(file.rows.size()) +
                  " poses, but there are " +
                  (scans.extent.empty() ? counted_text(scans.row_count, "scan") : scans.extent) +
                  (scans.more_rows ? "; expected a row for each frame number from 0, at least "
                                   : "; expected a row for each scan in the order of the names, ") +
                  grouped_text(scans.row_count) + "." + remedy);
}

}  // namespace

std::shared_ptr<const SensorMotion> motion_along(const std::vector<Nanoseconds>& stamps,
                                                 const std::vector<std::optional<Pose>>& poses) {
  std::vector<StampedPose> stamped;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    const bool later = stamped.empty() || stamps[i] > stamped.back().stamp;
    if (poses[i] && later) stamped.push_back({stamps[i], *poses[i]});
  }
  if (stamped.empty()) return nullptr;
  std::vector<MotionStep> steps(1);
  steps[0].moving = Trajectory(std::move(stamped));
  return std::make_shared<SensorMotion>(std::move(steps), 0,
                                        std::numeric_limits<Nanoseconds>::max(), true);
}

void ScanKeys::add(std::size_t row, const StampColumn& times, double period_s) {
  rows.push_back(row);
  if (!times.stamps.empty()) stamps.push_back(times.stamps[row]);
  times_s.push_back(times.stamps.empty() ? static_cast<double>(row) * period_s
                                         : times.since_first[row]);
}

bool fits_rows(const PoseFile& file, const ScanKeys& scans) {
  return scans.more_rows ? file.rows.size() >= scans.row_count
                         : file.rows.size() == scans.row_count;
}

ScanPoses scan_poses(const PoseFile& file, const ScanKeys& scans, const PoseSettings& given) {
  const PoseSettings settings = settings_for(file, given);
  ScanPoses result;
  if (file.rows.size() == 1 && scans.row_count > 1) {
    refuse_offset(settings, "there is one pose for all scans");
    result = one_for_all(sensor_pose(rigid_pose(file, 0), settings), scans);
    result.notes.push_back(
        file.path.string() +
        ": holds one pose, which is used for all scans: the sensor is stationary.");
  } else if (file.rows.front().frame) {
    result = by_frame(file, scans, settings);
  } else if (file.stamped() && !scans.stamps.empty()) {
    result = by_time(file, scans, settings);
  } else {
    const PoseFile distinct = fits_rows(file, scans) ? file : without_repeats(file);
    if (!fits_rows(distinct, scans)) throw_rows(file, scans);
    result = by_row(distinct, scans, settings);
  }
  if (result.times_s.empty()) result.times_s = scans.times_s;
  result.notes.insert(result.notes.begin(), file.notes.begin(), file.notes.end());
  return result;
}

ScanPoses stationary_poses(const ScanKeys& scans, const PoseSettings& settings) {
  refuse_offset(settings, "the sensor is stationary");
  ScanPoses result = one_for_all(settings.T_body_sensor.value_or(Pose::Identity()), scans);
  result.times_s = scans.times_s;
  return result;
}

std::string ways_to_poses() {
  return "To estimate them from the scans, use --poses estimate. Odometry programs such as "
         "KISS-ICP, GLIM or FAST-LIO estimate poses, too, and raymoval reads their files (see "
         "docs/poses.md): --poses FILE. If the sensor was stationary, use --poses identity.";
}

}  // namespace raymoval
