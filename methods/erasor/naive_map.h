// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/scan/cell_set.h"
#include "core/scan/voxel_key.h"
#include "core/scan/voxel_numbers.h"

namespace raymoval::erasor_method {

/// A vector in chunks, which do not move when it grows, so that it is never in memory twice.
template <class Value>
class Chunks {
 public:
  [[nodiscard]] std::size_t size() const { return size_; }
  Value& operator[](std::size_t i) { return chunks_[i / kChunk][i % kChunk]; }
  const Value& operator[](std::size_t i) const { return chunks_[i / kChunk][i % kChunk]; }

  void push_back(const Value& value) {
    if (size_ % kChunk == 0) chunks_.push_back(std::make_unique_for_overwrite<Value[]>(kChunk));
    (*this)[size_++] = value;
  }

 private:
  static constexpr std::size_t kChunk = std::size_t{1} << 16;
  std::vector<std::unique_ptr<Value[]>> chunks_;
  std::size_t size_ = 0;
};

/// The number of a voxel in a NaiveMap.
using VoxelNumber = std::uint32_t;

/// The map of all scans: filled voxels of the world lattice, each with one point and either in the
/// map or removed. Square tiles find voxels by place, so that the cost of a search around a pose
/// does not depend on the size of the map.
class NaiveMap {
 public:
  /// Half-open range of voxel numbers that make up one tile.
  struct Tile {
    VoxelNumber begin = 0, end = 0;
  };

  /// @param keys one per voxel, without duplicates
  /// @param points of the voxels, world frame, metres
  NaiveMap(Chunks<VoxelKey> keys, Chunks<Eigen::Vector3d> points);

  [[nodiscard]] std::size_t size() const { return keys_.size(); }
  [[nodiscard]] const Eigen::Vector3d& point(VoxelNumber voxel) const { return points_[voxel]; }
  [[nodiscard]] bool is_in(VoxelNumber voxel) const { return in_[voxel] != 0; }

  /// Tiles that may hold a point within `radius` of the vertical through (x, y).
  [[nodiscard]] std::vector<Tile> tiles_around(double x, double y, double radius) const;

  void take_out(VoxelNumber voxel) {
    in_[voxel] = 0;
    out_.insert(keys_[voxel]);
  }
  /// Puts a removed voxel back; no effect on other voxels.
  /// @param point any in the voxel
  void put_back(VoxelKey key, const Eigen::Vector3d& point);
  [[nodiscard]] bool is_out(VoxelKey key) const { return out_.contains(key); }

 private:
  void renumber(Chunks<VoxelNumber>& numbers);
  [[nodiscard]] VoxelNumber number_of(VoxelKey key, const Eigen::Vector3d& point) const;

  Chunks<VoxelKey> keys_;
  Chunks<Eigen::Vector3d> points_;
  std::vector<std::uint8_t> in_;
  CellSet out_;  ///< The removed voxels by key. They are few, so numbers are not stored.
  VoxelMap<Tile> tiles_;
};

/// Collects the naive map scan by scan. A voxel's point is the mean of the scans' mean points in
/// the voxel, because the public program thins every scan before it thins their sum.
///
/// It takes 41 to 43 bytes per voxel, and the map is made in the same memory.
class NaiveMapBuilder {
 public:
  /// The key of a point that does not belong to the map.
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
  Chunks<std::uint32_t> scans_;  ///< Number of scans in the voxel.
  VoxelNumbers numbers_;
  // Of the scan that is added:
  std::vector<VoxelOfScan> in_scan_;
  VoxelNumbers places_;  ///< In `in_scan_`.
};

}  // namespace raymoval::erasor_method
