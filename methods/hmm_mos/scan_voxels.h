// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/scan/scan.h"
#include "methods/common/scan_grid.h"
#include "methods/common/sparse_blocks.h"
#include "methods/hmm_mos/hmm_mos.h"
#include "methods/remover.h"

namespace raymoval::hmm_mos_method {

/// The lattice of the voxels.
class Lattice {
 public:
  explicit Lattice(const Parameters& parameters)
      : size_(parameters.voxel_size),
        inverse_(1.0 / parameters.voxel_size),
        corner_(parameters.public_lattice) {}

  /// The voxel of a point. @param world metres
  /// @throws DataError beyond the common lattice
  [[nodiscard]] VoxelIndex voxel_of(const Eigen::Vector3d& world) const {
    if (!corner_) return voxel_index(world, inverse_);
    const VoxelIndex magnitude = voxel_index(world.cwiseAbs(), inverse_);
    return (world.array() < 0.0).select(-magnitude, magnitude);
  }
  /// The voxel in which rays begin. @param world metres
  [[nodiscard]] VoxelIndex sensor_voxel(const Eigen::Vector3d& world) const {
    return voxel_index(world, inverse_);
  }
  /// The position of a voxel for distances, metres.
  [[nodiscard]] Eigen::Vector3d position(const VoxelIndex& voxel) const {
    return (voxel.cast<double>().array() + (corner_ ? 0.0 : 0.5)).matrix() * size_;
  }
  [[nodiscard]] double size() const { return size_; }  ///< Edge of a voxel, metres.

 private:
  double size_, inverse_;
  bool corner_;
};

/// In a scan's grid, `hit` is the occupied voxels, and `free` all observed voxels, including ends
/// of rays. Both are within range.
using namespace scan_grid;

/// The number of a column in its block, from its indices in it.
constexpr std::size_t column_at(int x, int y) {
  return static_cast<std::size_t>(x * kSide + y);
}
/// The voxel of a bit of a column of a block.
inline VoxelIndex voxel_at(const VoxelIndex& block, std::size_t column, int height) {
  const int place = static_cast<int>(column);
  return {block.x() * kSide + place / kSide, block.y() * kSide + place % kSide,
          block.z() * kHeight + height};
}

/// A grid for the voxels of scans.
inline ScanGrid empty_grid() {
  return ScanGrid("Set a smaller hmm_mos.max_range, or a larger hmm_mos.voxel_size.");
}

/// Looks up columns in a constant grid.
class ColumnLookup {
 public:
  explicit ColumnLookup(const ScanGrid& grid) : blocks_(grid) {}

  /// A column of a block; empty if the scan has none.
  const Column& column(const VoxelIndex& block, std::size_t column) {
    static constexpr Column kEmpty{};
    const ScanBlock* found = blocks_.find(block);
    return found == nullptr ? kEmpty : found->columns[column];
  }
  bool is_occupied(const VoxelIndex& voxel) {
    return (column(block_of(voxel), column_of(voxel)).hit & bit_of(voxel)) != 0;
  }

 private:
  BlockFinder<ScanGrid> blocks_;
};

/// Whether a point is far enough from its sensor to be used; false if it is not finite.
inline bool counts(const Eigen::Vector3f& point, const Parameters& parameters) {
  return point.cast<double>().norm() > parameters.min_range;
}

/// The voxels of one scan. `clear` keeps the memory for the next one.
struct ScanVoxels {
  ScanGrid grid = empty_grid();  ///< Voxels within range.
  std::vector<VoxelIndex>
      beyond;  ///< Occupied voxels beyond the range, in the order of the points.
};

/// Steps 1 and 2: the occupied voxels of a scan, and the voxels that it observes on its rays.
/// @param voxels are overwritten
/// @throws DataError for points beyond the common lattice; Cancelled
void find_voxels(const Scan& scan, const Parameters& parameters, const RunContext& context,
                 ScanVoxels& voxels);

/// The occupied voxels of two scans beyond their ranges, in and around the blocks of the first
/// scan's grid: in step 3 they may be the nearest ones to a voxel within range.
/// @param near is overwritten
void find_beyond(const ScanVoxels& now, const ScanVoxels& before, ScanGrid& near);

}  // namespace raymoval::hmm_mos_method
