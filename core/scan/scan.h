// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace raymoval {

/// Rigid motion `T_world_sensor`: takes points of the sensor frame to the world frame (metres).
using Pose = Eigen::Isometry3d;

/// One mask value per point of a scan: 1 = removed, 0 = kept.
using Mask = std::vector<std::uint8_t>;

/// One sweep of the sensor. Every coordinate is finite, and missing returns are left out; they are
/// only counted (`stored_point_count`).
struct Scan {
  std::size_t index = 0;  ///< Position in its source, 0 .. size() - 1.
  std::string name;       ///< Name of the frame in its data set, such as "000123".
  double time_s = 0.0;    ///< Seconds since the first scan of the data set.
  Pose T_world_sensor = Pose::Identity();
  std::vector<Eigen::Vector3f> points;  ///< Sensor frame, metres.
  std::vector<float> reflectance;       ///< As long as `points`, or empty if the data has none.

  std::size_t stored_point_count = 0;       ///< Points in the file, those left out included.
  std::vector<std::uint32_t> stored_index;  ///< File position of each point; empty = identity.

  [[nodiscard]] std::size_t size() const { return points.size(); }
  [[nodiscard]] std::size_t left_out_count() const { return stored_point_count - points.size(); }
  [[nodiscard]] std::size_t stored_position(std::size_t point) const {
    return stored_index.empty() ? point : stored_index[point];
  }
};

}  // namespace raymoval
