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

/// What is said of poses besides their file.
struct PoseSettings {
  /// As a user says it; nothing: the poses are those of the sensor.
  std::optional<Pose> T_body_sensor = std::nullopt;
  /// Calibration "Tr" where the poses P are those of a camera: then Tr^-1 P Tr is that of the
  /// LiDAR.
  std::optional<Pose> T_camera_lidar = std::nullopt;
  Nanoseconds time_offset = 0;
  Nanoseconds max_gap = kUsualMaxGap;
};

/// The scans that poses are looked for, by what is known of them.
struct ScanKeys {
  /// Row of the pose file for each scan, for poses that belong to scans by their order.
  std::vector<std::size_t> rows;
  std::vector<long> frames = {};  ///< Number of each scan in its name; empty: it is in `rows`.
  std::size_t row_count = 0;  ///< Rows that the file has at least then; the highest of `rows` + 1.
  bool more_rows = false;     ///< Whether the file may have more of them.
  std::string extent;         ///< For messages: "2 scans, a.pcd to b.pcd".
  /// The time of each scan, on a clock of its own. Empty if scans have no times.
  std::vector<Nanoseconds> stamps;
  /// Seconds since the first scan of the data set, of each scan; assumed if nobody knows them.
  std::vector<double> times_s;

  /// Adds the scan whose pose and time are in row `row` of their files.
  /// @param times of all rows; without any, scans are `period_s` seconds apart
  void add(std::size_t row, const StampColumn& times, double period_s);
};

/// The poses of scans. All lists are as long as `ScanKeys::rows`.
struct ScanPoses {
  std::vector<std::optional<Pose>> poses;  ///< T_world_sensor; nothing: to be left out.
  std::vector<Nanoseconds> stamps;         ///< Of each scan, on the clock of `motion`.
  std::vector<double> times_s;             ///< Seconds since the first scan of the data set.
  std::shared_ptr<const SensorMotion> motion;
  std::vector<std::string> notes;   ///< How the file was read.
  std::vector<std::string> losses;  ///< How many scans have no pose.
  std::optional<PoseGap> gap;       ///< As in `FoundPoses`.
};

/// Whether the rows of `file` fit scans by their order.
bool fits_rows(const PoseFile& file, const ScanKeys& scans);

/// The poses of scans:
/// - a file with one pose is that of all scans, for a sensor that stands;
/// - a file with times is looked up by time if the scans have times (see `look_up_poses`);
/// - a file with numbers of frames has a pose for the scans of these numbers;
/// - in all other files a row belongs to a scan by its order.
/// @throws DataError if the rows do not fit the scans, a pose is damaged, or as `look_up_poses`;
///   UsageError for a shift of the clock where poses do not go by time
ScanPoses scan_poses(const PoseFile& file, const ScanKeys& scans, const PoseSettings& settings);

/// The same for a sensor that stands at the origin of the world all the time.
ScanPoses standing_poses(const ScanKeys& scans, const PoseSettings& settings);

/// Motion along poses that belong to scans by their order. All gaps are bridged, because which time
/// passed between such scans is often assumed. Null if there is no pose.
/// @param stamps of the scans; a scan that is not later than the one before gives no pose
std::shared_ptr<const SensorMotion> motion_along(const std::vector<Nanoseconds>& stamps,
                                                 const std::vector<std::optional<Pose>>& poses);

/// What to do where there are no poses: sentences that name programs which find them.
std::string ways_to_poses();

}  // namespace raymoval
