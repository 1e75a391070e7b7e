// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/scan.h"
#include "core/voxel_key.h"

namespace raymoval {

/// Collects points in the world frame. With a voxel size it keeps the mean of the points of each
/// occupied cell, so that memory is bounded by the map and not by the number of scans; without one
/// it keeps every point.
class MapCollector {
 public:
  /// @param voxel_size metres; 0 keeps every point
  explicit MapCollector(double voxel_size) : voxel_size_(voxel_size) {}

  /// Adds the points of `scan` whose mask value is `wanted`.
  void add(const Scan& scan, const Mask& mask, std::uint8_t wanted);

  /// Points in metres in the world frame: in order of arrival, or by cell along x, y, z.
  [[nodiscard]] std::vector<Eigen::Vector3f> points() const;
  /// Reflectance of each point (the mean of a cell's); empty if a scan had none.
  [[nodiscard]] std::vector<float> reflectance() const;

 private:
  struct Cell {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double reflectance = 0.0;
    std::uint64_t count = 0;
  };
  [[nodiscard]] std::vector<VoxelKey> sorted_keys() const;

  double voxel_size_;
  bool has_reflectance_ = true;
  VoxelMap<Cell> cells_;
  std::vector<Eigen::Vector3f> points_;
  std::vector<float> reflectance_;
};

}  // namespace raymoval
