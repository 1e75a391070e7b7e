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

/// The settings of a sequence: the user's options, else its sequence.json, else the layout's
/// defaults.
struct SequenceSettings {
  std::string name;
  std::string source;
  FrameRange frames;
  std::optional<std::string> poses;  ///< A name in the folder or a path.
  bool poses_are_lidar = false;      ///< The poses are those of the LiDAR, not of a camera.
  std::optional<std::string> sensor;
  std::optional<std::string> point_layout;  ///< See `parse_point_layout`.
  std::optional<Eigen::Vector3d> up;        ///< Unit vector of the world frame.
  EgoRegion drop_ego;
  std::optional<double> scan_period_s;
  RangeLimits range_m;
  LabelRule label_rule;
  bool label_rule_given = false;  ///< Whether an option or sequence.json gives it.
  bool moving_now = false;        ///< Whether the rule is `kMovingNow`.
  std::optional<std::string> pose_format;
  std::optional<std::string> T_sensor;        ///< A file, or seven numbers.
  std::optional<SensorPlaces> sensor_origin;  ///< In the frame of the points.
  std::optional<double> time_offset_s;
  std::optional<double> max_gap_s;
  std::optional<PointFrame> points;
  bool deskew = false;
  std::optional<std::string> point_time_unit;
  bool skip_bad_scans = false;
  std::vector<std::filesystem::path> input_files;  ///< Files of these settings.
};

/// Reads `folder`/sequence.json, if it exists, and applies `options`. Its keys, all optional:
/// name, source, sensor (a known sensor, or "estimated" or "" for none), point_layout, up, drop_ego
/// (as `parse_ego_region`, or a number of metres), scan_period_s, poses, pose_format,
/// poses_are_lidar, T_sensor, sensor_origin, time_offset_s, max_gap_s, points ("sensor" or
/// "world"), deskew, point_time_unit, skip_bad_scans, range_m {min, max}, labels {name, moving,
/// ignored}.
/// @param defaults used if neither has a value; its `name`, if any, replaces the file's
/// @throws ConfigurationError for an unknown key (with the nearest known one) or an illegal value
SequenceSettings read_settings(const std::filesystem::path& folder, const SequenceOptions& options,
                               const SequenceSettings& defaults);

/// The part of `settings` on poses.
/// @param folder of the sequence, in which the file of --T-sensor is searched first
/// @param input_files gets that file
/// @throws UsageError, DataError as `read_body_sensor`
PoseSettings pose_settings(const SequenceSettings& settings, const std::filesystem::path& folder,
                           std::vector<std::filesystem::path>& input_files);

/// The first option about poses or their times that `settings` has, "--T-sensor"; empty if there is
/// none.
std::string first_pose_setting(const SequenceSettings& settings);

/// "sensor" or "world". @param option for the message @throws UsageError
PointFrame parse_point_frame(const std::string& option, const std::string& text);

/// "drop_ego" of a sequence.json or a suite. @throws ConfigurationError listing its forms
EgoRegion ego_region_value(const nlohmann::json& value, const std::string& where);

/// Applies `options` to the `settings` of a sequence without a folder.
SequenceSettings apply_options(const SequenceOptions& options, SequenceSettings settings);

/// Default time between scans, seconds: most spinning sensors turn at 10 Hz.
inline constexpr double kUsualScanPeriod = 0.1;

/// Used in place of a pose file for a stationary sensor.
inline constexpr const char* kStationarySensor = "identity";

/// The pose file `name`: a file in `folder`, else a path.
/// @param name poses.txt if empty
/// @throws DataError naming the existing files, and ways to get poses
std::filesystem::path find_pose_file(const std::filesystem::path& folder,
                                     const std::optional<std::string>& name);

}  // namespace raymoval
