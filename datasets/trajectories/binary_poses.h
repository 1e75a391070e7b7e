// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "datasets/trajectories/pose_file.h"

namespace raymoval::pose_formats {

/// The names of the forms that are no text of rows.
std::vector<PoseFormatName> binary_format_names();

/// Reads `path` if it is, or is said to be, an .npy array of matrices or a .pcd file of key poses.
/// @return nothing if it is a text of rows
/// @throws DataError
std::optional<PoseFile> read_binary_poses(const std::filesystem::path& path,
                                          const PoseReading& reading);

}  // namespace raymoval::pose_formats
