// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/scan/voxel_key.h"

namespace raymoval::scan_grid {

/// Voxels come in blocks of 32 x 32 upright columns of 64. A word holds a column: LiDAR beams are
/// mostly level, so that neighbours on a beam are in different words and can be marked
/// independently.
inline constexpr int kSideBits = 5;
inline constexpr int kSide = 1 << kSideBits;
inline constexpr int kHeightBits = 6;
inline constexpr int kHeight = 1 << kHeightBits;
inline constexpr int kColumns = kSide * kSide;

/// Block of a voxel: its indices divided by the block's sides, rounded down.
inline VoxelIndex block_of(const VoxelIndex& voxel) {
  return {voxel.x() >> kSideBits, voxel.y() >> kSideBits, voxel.z() >> kHeightBits};
}
/// Column of a voxel in its block.
inline std::size_t column_of(const VoxelIndex& voxel) {
  return static_cast<std::size_t>((voxel.x() & (kSide - 1)) * kSide + (voxel.y() & (kSide - 1)));
}
/// Bit of a voxel in its column.
inline std::uint64_t bit_of(const VoxelIndex& voxel) {
  return std::uint64_t{1} << (voxel.z() & (kHeight - 1));
}

/// The observation of a column of voxels by one scan. Each voxel has a bit, the lowest voxel the
/// lowest bit.
struct Column {
  std::uint64_t free = 0;  ///< Beams of the scan pass through it.
  std::uint64_t hit = 0;   ///< The scan has a return there.
};

struct ScanBlock {
  VoxelIndex at = VoxelIndex::Zero();  ///< Block indices (see `block_of`).
  /// The neighbours below and above along x, y and z, or null where no beam went there.
  std::array<std::array<ScanBlock*, 2>, 3> beside{};
  std::array<Column, kColumns> columns{};
};

/// The hits and the free voxels of one scan, in sparse blocks. `clear` keeps the memory for the
/// next scan.
class ScanGrid {
 public:
  /// The largest number of blocks (16 KiB each). No scan of a real place needs as many.
  static constexpr std::size_t kMostBlocks = std::size_t{1} << 18;

  /// @param remedy the remedy for more than `kMostBlocks`, for the error
  explicit ScanGrid(std::string remedy = "Remove the farthest points.")
      : remedy_(std::move(remedy)) {}

  /// The block at these block indices. It is made if there is none yet. References stay valid until
  /// `clear`. @throws DataError beyond `kMostBlocks`.
  ScanBlock& block(const VoxelIndex& at) {
    if (last_ != nullptr && last_->at == at) return *last_;
    const VoxelKey key = voxel_key(at);
    const auto found = index_.find(key);
    last_ = found != index_.end() ? blocks_[found->second].get() : &add_block(at, key);
    return *last_;
  }
  /// The neighbour of a block along an axis; `step` is +1 or -1. It is made if there is none yet.
  ScanBlock& beside(ScanBlock& from, Eigen::Index axis, int step) {
    ScanBlock*& link = from.beside[static_cast<std::size_t>(axis)][step > 0 ? 1 : 0];
    if (link == nullptr) {
      VoxelIndex at = from.at;
      at[axis] += step;
      link = &block(at);
    }
    return *link;
  }
  /// The block at these block indices, or null.
  [[nodiscard]] const ScanBlock* find(const VoxelIndex& at) const {
    const auto found = index_.find(voxel_key(at));
    return found == index_.end() ? nullptr : blocks_[found->second].get();
  }
  Column& column(const VoxelIndex& voxel) {
    return block(block_of(voxel)).columns[column_of(voxel)];
  }

  [[nodiscard]] std::size_t size() const { return used_; }
  [[nodiscard]] const ScanBlock& operator[](std::size_t i) const { return *blocks_[i]; }
  void clear() {
    index_.clear();
    used_ = 0;
    last_ = nullptr;
  }

 private:
  ScanBlock& add_block(const VoxelIndex& at, VoxelKey key);

  std::string remedy_;
  VoxelMap<std::uint32_t> index_;
  std::vector<std::unique_ptr<ScanBlock>> blocks_;  ///< The first `used_` are this scan's.
  std::size_t used_ = 0;
  ScanBlock* last_ = nullptr;  ///< The last block, which is mostly needed again.
};

/// Marks the voxels that beams of one scan pass through.
class FreeWalk {
 public:
  /// Longest beam, in voxels.
  static constexpr double kLongest = 1 << 17;

  /// @param sensor world position in voxels
  /// @param grid holds the hits of the scan
  FreeWalk(const Eigen::Vector3d& sensor, ScanGrid& grid);

  /// Marks the voxels of a beam up to and including the first hit, if it enters one.
  /// @param direction of unit length
  /// @param length of the beam in voxels, at most `kLongest`
  /// @return the last voxel marked
  VoxelIndex mark_free(const Eigen::Vector3d& direction, double length);

 private:
  ScanGrid& grid_;
  VoxelIndex sensor_block_;
  Eigen::Vector3d sensor_;  ///< Voxels from the low corner of the sensor's block.
};

}  // namespace raymoval::scan_grid
