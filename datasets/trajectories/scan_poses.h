// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "datasets/trajectories/pose_file.h"
#include "datasets/trajectories/stamps.h"
#include "datasets/trajectories/trajectory.h"

namespace raymoval {

/// Facts on poses that are not in their file.
struct PoseSettings {
  /// As the user gave it; empty: the poses are those of the sensor.
  std::optional<Pose> T_body_sensor = std::nullopt;
  /// Calibration "Tr" if the poses P are those of a camera: Tr^-1 P Tr is the pose of the LiDAR.
  std::optional<Pose> T_camera_lidar = std::nullopt;
  Nanoseconds time_offset = 0;
  Nanoseconds max_gap = kUsualMaxGap;
};

/// Rows, frame numbers and times of scans, to look up their poses.
struct ScanKeys {
  /// Row of the pose file for each scan, for poses that are assigned by order.
  std::vector<std::size_t> rows;
  std::vector<long> frames = {};  ///< Frame number in the name of each scan; empty: see `rows`.
  std::size_t row_count = 0;      ///< Least number of rows of the file; the highest of `rows` + 1.
  bool more_rows = false;         ///< Whether the file may have more rows.
  std::string extent;             ///< For messages: "2 scans, a.pcd to b.pcd".
  /// The time of each scan, on the clock of the scans. Empty if scans have no times.
  std::vector<Nanoseconds> stamps;
  /// Seconds since the first scan of the data set, of each scan; assumed if unknown.
  std::vector<double> times_s;

  /// Adds the scan whose pose and time are in row `row` of their files.
  /// @param times of all rows; without any, scans are `period_s` seconds apart
  void add(std::size_t row, const StampColumn& times, double period_s);
};

/// The poses of scans. All lists are as long as `ScanKeys::rows`.
struct ScanPoses {
  std::vector<std::optional<Pose>> poses;  ///< T_world_sensor; empty: scan is left out.
  std::vector<Nanoseconds> stamps;         ///< Of each scan, on the clock of `motion`.
  std::vector<double> times_s;             ///< Seconds since the first scan of the data set.
  std::shared_ptr<const SensorMotion> motion;
  std::vector<std::string> notes;   ///< How the file was read.
  std::vector<std::string> losses;  ///< The number of scans without a pose.
  std::optional<PoseGap> gap;       ///< As in `FoundPoses`.
};

/// Whether the rows of `file` can be assigned to scans by order.
bool fits_rows(const PoseFile& file, const ScanKeys& scans);

/// The poses of scans:
/// - a single pose is used for all scans: the sensor is stationary;
/// - poses with times are looked up by time if the scans have times (see `look_up_poses`);
/// - poses with frame numbers are looked up by frame number;
/// - all other poses are assigned to scans by order.
/// @throws DataError if the rows do not fit the scans, a pose is damaged, or as `look_up_poses`;
///   UsageError for a time offset if poses are not looked up by time
ScanPoses scan_poses(const PoseFile& file, const ScanKeys& scans, const PoseSettings& settings);

/// The same for a stationary sensor at the origin of the world.
ScanPoses stationary_poses(const ScanKeys& scans, const PoseSettings& settings);

/// Motion along poses that are assigned to scans by order. All gaps are interpolated, because the
/// times of such scans are often assumed. Null if there is no pose.
/// @param stamps of the scans; a scan that is not later than its predecessor is skipped
std::shared_ptr<const SensorMotion> motion_along(const std::vector<Nanoseconds>& stamps,
                                                 const std::vector<std::optional<Pose>>& poses);

/// For data without poses: sentences that name programs which estimate poses.
std::string ways_to_poses();

}  // namespace raymoval
