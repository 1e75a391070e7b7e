// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/scan/scan_source.h"
#include "core/scan/voxel_key.h"
#include "datasets/clouds/cloud_writer.h"

namespace raymoval {

/// How a map is written so that coordinates lose no digits.
struct MapPrecision {
  /// The origin from which voxels are counted, see `lattice_origin`.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  /// float64 where a sensor is so far from the world's origin that float32 loses a millimetre.
  Coordinates coordinates = Coordinates::kFloat;
};
MapPrecision map_precision(const ScanSource& scans);

/// Writes a map in the world frame, scan by scan. With a voxel size it holds one sum for each
/// occupied cell, so that memory is bounded by the map. Without one it writes points as they come,
/// and memory is bounded by a scan. It never depends on the number of scans.
class MapWriter {
 public:
  /// @param path a cloud file, see `CloudWriter`
  /// @param voxel_size in metres; 0 keeps every point, otherwise a cell has the mean of its points
  /// @throws UsageError if the file's format cannot hold the coordinates
  MapWriter(const std::filesystem::path& path, double voxel_size,
            const MapPrecision& precision = {})
      : file_(path), voxel_size_(voxel_size), precision_(precision) {
    check_coordinates(path, precision.coordinates);
  }

  /// Adds the points of `scan` whose mask value is `wanted`. With a voxel size the map has
  /// reflectance if all scans have it. Without one it has reflectance if the first scan with a
  /// point has it, and the value is 0 for later scans that have none.
  void add(const Scan& scan, const Mask& mask, std::uint8_t wanted);
  /// Ends the file. Points stand in order of arrival, or by cell along x, y, z.
  /// @return the number of points written
  std::uint64_t finish();
  /// Gives the file its name, after `finish`.
  void commit() { file_.commit(); }
  /// The same together with others.
  void commit_with(Replacements& together) { file_.commit_with(together); }

 private:
  struct Cell {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();  ///< From `MapPrecision::origin`.
    double reflectance = 0.0;
    std::uint64_t count = 0;
  };
  void start(bool with_reflectance);
  void write_buffer();
  void write_cells();

  CloudWriter file_;
  double voxel_size_;
  MapPrecision precision_;
  bool started_ = false;
  bool has_reflectance_ = true;
  std::uint64_t written_ = 0;
  VoxelMap<Cell> cells_;
  std::vector<Eigen::Vector3d> points_;  ///< To be written next.
  std::vector<float> reflectance_;
};

}  // namespace raymoval
