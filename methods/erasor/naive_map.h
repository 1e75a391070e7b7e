// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/scan/voxel_key.h"
#include "core/scan/voxel_numbers.h"
#include "methods/erasor/chunks.h"

namespace raymoval::erasor_method {

/// The number of a voxel in a NaiveMap.
using VoxelNumber = std::uint32_t;

/// The map of all scans: filled voxels of the world lattice, each with one point and either in the
/// map or out of it. Found by place through square tiles, so that looking around a pose costs what
/// lies there and not what the map holds.
class NaiveMap {
 public:
  /// Half-open range of voxel numbers that make up one tile.
  struct Tile {
    VoxelNumber begin = 0, end = 0;
  };

  /// @param keys a voxel each, none twice
  /// @param points of the voxels, world frame, metres
  /// @param numbers as many; their memory is used to sort the voxels
  NaiveMap(Chunks<VoxelKey> keys, Chunks<Eigen::Vector3d> points, Chunks<VoxelNumber> numbers);

  [[nodiscard]] std::size_t size() const { return keys_.size(); }
  [[nodiscard]] const Eigen::Vector3d& point(VoxelNumber voxel) const { return points_[voxel]; }
  [[nodiscard]] bool is_in(VoxelNumber voxel) const { return in_[voxel] != 0; }

  /// Tiles that may hold a point within `radius` of the vertical through (x, y).
  [[nodiscard]] std::vector<Tile> tiles_around(double x, double y, double radius) const;

  void take_out(VoxelNumber voxel) {
    in_[voxel] = 0;
    out_[keys_[voxel]] = voxel;
  }
  /// Puts a voxel back if it is out; does nothing if it is in or not in the map at all.
  void put_back(VoxelKey key);
  [[nodiscard]] bool is_out(VoxelKey key) const { return out_.contains(key); }

 private:
  void renumber(Chunks<VoxelNumber>& numbers);

  Chunks<VoxelKey> keys_;
  Chunks<Eigen::Vector3d> points_;
  std::vector<std::uint8_t> in_;
  VoxelMap<VoxelNumber> out_;
  VoxelMap<Tile> tiles_;
};

/// Collects the naive map scan by scan. A voxel's point is the mean over the scans that fill it of
/// each scan's own mean: the public program thins every scan before it thins their sum.
///
/// It takes 41 to 43 bytes a voxel, and the map is made in the same memory.
class NaiveMapBuilder {
 public:
  /// Stands for a point that does not belong to the map.
  static constexpr VoxelKey kNoVoxel = ~VoxelKey{0};

  /// Adds a scan: voxel and world point of each of its points.
  void add(const std::vector<VoxelKey>& keys, const std::vector<Eigen::Vector3d>& points);
  /// The map. Called once, after the last scan.
  [[nodiscard]] NaiveMap finish();

 private:
  struct VoxelOfScan {
    VoxelKey key;
    Eigen::Vector3d sum;
    std::uint32_t points;
  };

  // By number:
  Chunks<VoxelKey> keys_;
  Chunks<Eigen::Vector3d> sums_of_means_;
  Chunks<VoxelNumber> scans_;  ///< How many fill the voxel.
  VoxelNumbers numbers_;
  // Of the scan that is added:
  std::vector<VoxelOfScan> in_scan_;
  VoxelNumbers places_;  ///< In `in_scan_`.
};

}  // namespace raymoval::erasor_method
