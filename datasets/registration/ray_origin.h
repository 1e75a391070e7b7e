// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/scan/scan.h"

namespace raymoval::registration {

/// The origin of the rays of a spinning LiDAR, from its scan lines.
struct RayOrigin {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< Frame of the points, metres.
  std::size_t lines = 0;                             ///< Used pieces of scan lines.
  double misfit_given = 1;  ///< Of the lines to the frame's origin, 0 (all fit) to 1 (none fits).
  double misfit_found = 1;  ///< Of the lines to `origin`.
};

/// Finds the origin of the rays. Each beam of a spinning LiDAR has one elevation, so its rays form
/// a cone around the sensor's axis. Seen from the origin, a scan line on any surface keeps its
/// elevation. The result is the origin within 3 m of the frame's origin for which most lines keep
/// their elevation. For a solid-state or non-repetitive LiDAR, no origin fits, and `misfit_found`
/// is high.
/// @param scans points in one frame that is fixed to the sensor, z along its axis
RayOrigin find_ray_origin(const std::vector<Scan>& scans);

/// The origins of two LiDARs whose clouds were merged, at least 0.8 m apart, if either half of
/// `scans` shows the same two within 0.4 m; else nothing. Lines of one LiDAR do not repeat that.
/// @param scans as `find_ray_origin`, at least two
std::optional<std::array<Eigen::Vector3d, 2>> find_merged_origins(const std::vector<Scan>& scans);

}  // namespace raymoval::registration
