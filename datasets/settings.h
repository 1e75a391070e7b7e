// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "datasets/sequence.h"

namespace raymoval {

/// What holds for a sequence: the user's options over its sequence.json over defaults.
struct SequenceSettings {
  std::string name;
  std::string source;
  FrameRange frames;
  std::optional<std::string> poses;  ///< As given: a name in the folder or a path.
  bool poses_are_lidar = false;      ///< Poses need no calibration.
  std::optional<std::string> sensor;
  std::optional<Eigen::Vector3d> up;  ///< Unit vector of the world frame.
  EgoRegion drop_ego;
  std::optional<double> scan_period_s;
  RangeLimits range_m;
  LabelRule label_rule;
  bool label_rule_given = false;  ///< By an option or sequence.json.
};

/// Reads `folder`/sequence.json if there is one and lays `options` over it. Its keys, all optional:
/// name, source, sensor (a known sensor, or "estimated" or "" for none), up, drop_ego (as
/// `parse_ego_region`, or a number of metres), scan_period_s, poses, poses_are_lidar, range_m {min,
/// max}, labels {name, moving, ignored}.
/// @param defaults what holds where neither says anything; a `name` in it stands above the file's
/// @throws ConfigurationError for an unknown key (with the nearest known one) or an illegal value
SequenceSettings read_settings(const std::filesystem::path& folder, const SequenceOptions& options,
                               const SequenceSettings& defaults);

/// "drop_ego" of a sequence.json or a suite. @throws ConfigurationError saying what the forms are
EgoRegion ego_region_value(const nlohmann::json& value, const std::string& where);

/// Lays `options` over `defaults` for a sequence without a folder.
SequenceSettings apply_options(const SequenceOptions& options, SequenceSettings settings);

/// Seconds between scans where nothing says otherwise: spinning sensors mostly turn at 10 Hz.
inline constexpr double kUsualScanPeriod = 0.1;

/// A sequence with everything but its scans, labels and pose file filled in.
/// @param range as used, both ends set
Sequence make_sequence(const SequenceSettings& settings, const std::string& layout,
                       const FrameRange& range);

/// The pose file `name`: one in `folder`, else a path. @throws DataError naming what there is
std::filesystem::path find_pose_file(const std::filesystem::path& folder, const std::string& name);

}  // namespace raymoval
