// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/scan/scan.h"

namespace raymoval {

/// T_body_sensor: the pose of the sensor in the frame of the body of a trajectory.
struct BodySensor {
  Pose T_body_sensor = Pose::Identity();
  std::optional<std::filesystem::path> file;  ///< Its file, if any.
};

/// Reads `--T-sensor`: seven numbers x,y,z,qx,qy,qz,qw, or a file with these, or with a 3 x 4 or
/// 4 x 4 matrix row by row, in any lines.
/// @param folder of the sequence, in which a file is searched first
/// @throws UsageError if it is neither numbers nor a file; DataError for a file or numbers that are
///   no rigid pose
BodySensor read_body_sensor(const std::string& text, const std::filesystem::path& folder);

}  // namespace raymoval
