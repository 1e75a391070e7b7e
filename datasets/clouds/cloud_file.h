// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/scan/scan.h"

namespace raymoval {

/// Points as a file stores them, non-finite ones included.
struct Cloud {
  std::vector<Eigen::Vector3f> points;
  /// PCD and PLY: field intensity, reflectance or reflectivity; .bin: the fourth number. As long as
  /// `points`, or empty if the file has no such field.
  std::vector<float> intensity;
};

/// Extensions read and written here: .pcd, .ply, .bin.
const std::vector<std::string>& cloud_extensions();

/// Reads .bin (float32 x y z reflectance, little-endian), .pcd (ascii, binary, binary_compressed)
/// or .ply (ascii, binary of either endianness; vertices first).
/// @throws DataError naming the file, and the byte, point or line that is wrong; UsageError for
///   another extension
/// @param origin metres, taken off each point in double precision before it is rounded to float32:
///   near it, points far from the file's own origin keep their digits
/// @note VIEWPOINT is never applied to the points.
Cloud read_cloud(const std::filesystem::path& path,
                 const Eigen::Vector3d& origin = Eigen::Vector3d::Zero());

/// Sensor pose from the VIEWPOINT entry of a .pcd file, without reading its points.
/// @throws DataError if there is none or it is no rigid pose
Pose read_viewpoint(const std::filesystem::path& path);

/// Checks the size of a .bin scan. @throws DataError if `bytes` is not a multiple of 16
void check_bin_size(const std::filesystem::path& path, std::uintmax_t bytes);

}  // namespace raymoval
