// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "datasets/sequence.h"

namespace raymoval {

/// Opens a plain folder of scans in the sensor frame (.pcd, .ply, .bin), in natural order of their
/// names, with one pose of the LiDAR a scan in `poses.txt` or the pose file named (KITTI or TUM
/// rows). Frame numbers are positions in that order, from 0. `labels/NAME.label` is used if there
/// is such a folder.
/// @throws DataError if the counts of poses and scans differ
Sequence open_files(const std::filesystem::path& folder, const SequenceOptions& options);

}  // namespace raymoval
