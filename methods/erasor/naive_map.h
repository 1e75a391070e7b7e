// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/scan/voxel_key.h"

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
  NaiveMap(std::vector<VoxelKey> keys, std::vector<Eigen::Vector3d> points);

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
  void renumber(std::vector<VoxelNumber>& numbers);

  std::vector<VoxelKey> keys_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<std::uint8_t> in_;
  VoxelMap<VoxelNumber> out_;
  VoxelMap<Tile> tiles_;
};

/// Collects the naive map scan by scan. A voxel's point is the mean over the scans that fill it of
/// each scan's own mean: the public program thins every scan before it thins their sum.
///
/// It takes about 50 bytes a voxel: voxels stand in chunks, which do not move when more are added,
/// and are found by a table of their numbers alone.
class NaiveMapBuilder {
 public:
  /// Stands for a point that does not belong to the map.
  static constexpr VoxelKey kNoVoxel = ~VoxelKey{0};

  /// Adds a scan: voxel and world point of each of its points.
  void add(const std::vector<VoxelKey>& keys, const std::vector<Eigen::Vector3d>& points);
  /// The map. Called once, after the last scan.
  [[nodiscard]] NaiveMap finish();

 private:
  struct Voxel {
    VoxelKey key;
    Eigen::Vector3d sum_of_means;
    std::uint32_t scans;
    std::uint32_t slot;  ///< Its place in `in_scan_`, if `in_scan_[slot]` names this voxel too.
  };
  struct VoxelOfScan {
    VoxelNumber voxel;
    std::uint32_t points;
    Eigen::Vector3d sum;
  };
  static constexpr VoxelNumber kChunk = 1U << 16;  ///< Voxels.
  static constexpr VoxelNumber kFree = ~VoxelNumber{0};

  std::uint32_t slot_of(VoxelKey key);
  Voxel& voxel(VoxelNumber number) { return chunks_[number / kChunk][number % kChunk]; }
  VoxelNumber number_of(VoxelKey key);
  void grow_table();

  std::vector<std::unique_ptr<Voxel[]>> chunks_;
  VoxelNumber size_ = 0;
  /// A hash table of voxels' numbers, `kFree` where there is none. Its size is a power of two.
  std::vector<VoxelNumber> table_;
  std::vector<VoxelOfScan> in_scan_;
};

}  // namespace raymoval::erasor_method
