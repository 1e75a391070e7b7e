// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "datasets/sequence.h"
#include "datasets/trajectories/scan_poses.h"

namespace raymoval {

/// What holds for a sequence. The user's options stand above its sequence.json, and that stands
/// above the layout's defaults.
struct SequenceSettings {
  std::string name;
  std::string source;
  FrameRange frames;
  std::optional<std::string> poses;  ///< As the user gives it: a name in the folder or a path.
  bool poses_are_lidar = false;      ///< The poses are those of the LiDAR, not of a camera.
  std::optional<std::string> sensor;
  std::optional<std::string> point_layout;  ///< As `parse_point_layout` reads it.
  std::optional<Eigen::Vector3d> up;        ///< Unit vector of the world frame.
  EgoRegion drop_ego;
  std::optional<double> scan_period_s;
  RangeLimits range_m;
  LabelRule label_rule;
  bool label_rule_given = false;  ///< Whether an option or sequence.json gives it.
  bool moving_now = false;        ///< Whether the rule is `kMovingNow`.
  std::optional<std::string> pose_format;
  std::optional<std::string> T_sensor;        ///< As the user gives it: a file, or seven numbers.
  std::optional<SensorPlaces> sensor_origin;  ///< In the frame of the points.
  std::optional<double> time_offset_s;
  std::optional<double> max_gap_s;
  std::optional<PointFrame> points;
  bool deskew = false;
  std::optional<std::string> point_time_unit;
  bool skip_bad_scans = false;
  std::vector<std::filesystem::path> input_files;  ///< Those that all of this was read from.
};

/// Reads `folder`/sequence.json if there is one and lays `options` over it. Its keys, all optional:
/// name, source, sensor (a known sensor, or "estimated" or "" for none), point_layout, up, drop_ego
/// (as `parse_ego_region`, or a number of metres), scan_period_s, poses, pose_format,
/// poses_are_lidar, T_sensor, sensor_origin, time_offset_s, max_gap_s, points ("sensor" or
/// "world"), deskew, point_time_unit, skip_bad_scans, range_m {min, max}, labels {name, moving,
/// ignored}.
/// @param defaults what holds where neither says anything; a `name` in it stands above the file's
/// @throws ConfigurationError for an unknown key (with the nearest known one) or an illegal value
SequenceSettings read_settings(const std::filesystem::path& folder, const SequenceOptions& options,
                               const SequenceSettings& defaults);

/// What `settings` say of poses.
/// @param folder of the sequence, in which the file of --T-sensor is looked for first
/// @param input_files gets that file
/// @throws UsageError, DataError as `read_body_sensor`
PoseSettings pose_settings(const SequenceSettings& settings, const std::filesystem::path& folder,
                           std::vector<std::filesystem::path>& input_files);

/// The first option about poses or their times that `settings` has, "--T-sensor"; empty if there is
/// none.
std::string first_pose_setting(const SequenceSettings& settings);

/// "sensor" or "world". @param option for the message @throws UsageError
PointFrame parse_point_frame(const std::string& option, const std::string& text);

/// "drop_ego" of a sequence.json or a suite. @throws ConfigurationError saying what the forms are
EgoRegion ego_region_value(const nlohmann::json& value, const std::string& where);

/// Lays `options` over `defaults` for a sequence without a folder.
SequenceSettings apply_options(const SequenceOptions& options, SequenceSettings settings);

/// Seconds between scans where nothing says otherwise: spinning sensors mostly turn at 10 Hz.
inline constexpr double kUsualScanPeriod = 0.1;

/// What a user writes in place of a pose file for a sensor that stands.
inline constexpr const char* kStandingSensor = "identity";

/// The pose file `name`: one in `folder`, else a path.
/// @param name nothing if nobody named one: then it is poses.txt
/// @throws DataError naming what there is, and ways to poses
std::filesystem::path find_pose_file(const std::filesystem::path& folder,
                                     const std::optional<std::string>& name);

}  // namespace raymoval
