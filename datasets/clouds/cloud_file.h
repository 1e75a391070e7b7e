// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "core/scan/scan.h"
#include "datasets/clouds/format/cloud_bytes.h"
#include "datasets/clouds/formats.h"

namespace raymoval {

/// Reads positions and strengths of the points of a file of any known format, see `cloud_formats`.
/// @throws DataError naming the file, and the byte, point or line that is wrong; UsageError for
///   another extension or a point layout that cannot be
/// @param origin metres, taken off each point in double precision before it is rounded to float32:
///   near it, points far from the file's own origin keep their digits
/// @note VIEWPOINT is never applied to the points.
Cloud read_cloud(const std::filesystem::path& path,
                 const Eigen::Vector3d& origin = Eigen::Vector3d::Zero(),
                 const RecordReading& reading = {});

/// Sensor pose from the VIEWPOINT entry of a .pcd file, without reading its points.
/// @throws DataError if there is none or it is no rigid pose
Pose read_viewpoint(const std::filesystem::path& path);

/// Checks the size of a .bin scan.
/// @throws DataError if `bytes` is no multiple of the size of a point: that of the point layout, or
///   16
void check_bin_size(const std::filesystem::path& path, std::uintmax_t bytes,
                    const RecordReading& reading = {});

}  // namespace raymoval
