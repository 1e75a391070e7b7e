// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "datasets/simulation/scene/simulated.h"

namespace raymoval {

/// Form of `parse_scene`, for messages and listings.
inline constexpr const char* kSceneForm =
    "SCENE[:key=value,...] with the keys scans, seed, sensor, pose_noise, rolling, "
    "turned, tilted, roll, pitch and yaw";

/// Whether `text` names a built-in scene or an existing scene file (*.json), with or without
/// options. @throws DataError as `is_file`, for example for a file name that is too long
bool names_scene(const std::string& text);

/// Parses `town` or `town:scans=60,seed=3,sensor=vlp16,pose_noise=0,rolling=skewed`. It does not
/// check whether the sensor exists.
/// @throws UsageError naming the value, what was expected, and the nearest legal key
SimulationOptions parse_scene(const std::string& text);

/// Values as users write them; `what` names the value in messages.
/// @throws UsageError unless a whole number from 1 to 1,000,000.
std::size_t parse_scan_count(const std::string& what, const std::string& text);
/// @throws UsageError unless a whole number from 0 on.
std::uint64_t parse_seed(const std::string& what, const std::string& text);
/// @throws UsageError unless a number from 0 to 100.
double parse_pose_noise(const std::string& what, const std::string& text);
/// Degrees. @throws UsageError unless a number from -360 to 360.
double parse_turn(const std::string& what, const std::string& text);
/// @throws UsageError unless "none", "skewed" or "corrected".
Rolling parse_rolling(const std::string& what, const std::string& text);

}  // namespace raymoval
