// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/scan/scan.h"
#include "datasets/clouds/format/cloud_format.h"
#include "datasets/records/record_source.h"

namespace raymoval {

/// Counts of the stored points of a scan.
struct ReturnCounts {
  std::size_t stored = 0, no_returns = 0, infinite = 0;
  [[nodiscard]] std::size_t returns() const { return stored - no_returns - infinite; }
};

/// A point nearer to the sensor than this is a missing return, metres: no LiDAR measures so near.
inline constexpr float kAtSensor = 0.05F;

/// Keeps the points of `scan` at the positions `kept` (ascending), with their other data.
void keep_points(Scan& scan, std::vector<std::uint32_t> kept);

/// Fills the points, reflectances and stored indices of `scan` with the returns among the points
/// that `read` gives, in the sensor frame. Missing returns (a NaN coordinate, or within 5 cm of the
/// sensor; in the world frame also at its origin) and infinite points are left out.
/// @param scan with `T_world_sensor`
/// @param frame of the stored points
/// @param where begins the message, such as the file's path
/// @param remedy ends the message
/// @param read gives the stored points minus an origin in metres, see `read_cloud`
/// @throws DataError for more than 1 % infinite points (evaluation protocol, edge cases); the
///   errors of `read`
ReturnCounts read_returns(Scan& scan, PointFrame frame, const std::string& where,
                          const std::function<Cloud(const Eigen::Vector3d&)>& read,
                          const std::string& remedy = kRereadRemedy);

/// Removes the poses of scans that cannot be read, so that these scans are left out.
/// @param name of a scan, for messages
/// @param read reads a scan
/// @param losses gets a sentence on these scans, if there are any
/// @throws DataError if half of the scans or more cannot be read; Cancelled
void drop_bad_scans(std::vector<std::optional<Pose>>& poses,
                    const std::function<std::string(std::size_t)>& name,
                    const std::function<void(std::size_t)>& read, const std::atomic<bool>* cancel,
                    std::vector<std::string>& losses);

}  // namespace raymoval
