// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/scan/scan.h"
#include "methods/common/scan_grid.h"
#include "methods/hmm_mos/lattice.h"
#include "methods/remover.h"

namespace raymoval::hmm_mos_method {

/// In a scan's grid, `hit` is what is occupied, and `free` all that is observed, ends of rays too.
/// Both are within range.
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

/// Looks columns up in a grid that stays as it is. The block that was asked for last is mostly
/// asked for again.
class ColumnLookup {
 public:
  explicit ColumnLookup(const ScanGrid& grid) : grid_(grid), found_(grid.find(at_)) {}

  /// A column of a block; an empty one where the scan has nothing.
  const Column& column(const VoxelIndex& block, std::size_t column) {
    static constexpr Column kEmpty{};
    if (at_ != block) {
      found_ = grid_.find(block);
      at_ = block;
    }
    return found_ == nullptr ? kEmpty : found_->columns[column];
  }
  const Column& column(const VoxelIndex& voxel) {
    return column(block_of(voxel), column_of(voxel));
  }
  bool is_occupied(const VoxelIndex& voxel) { return (column(voxel).hit & bit_of(voxel)) != 0; }

 private:
  const ScanGrid& grid_;
  VoxelIndex at_ = VoxelIndex::Zero();
  const ScanBlock* found_;
};

/// Whether a point is far enough from its sensor to count. One that is not finite is not.
inline bool counts(const Eigen::Vector3f& point, const Parameters& parameters) {
  return point.cast<double>().norm() > parameters.min_range;
}

/// The voxels of one scan. `clear` keeps the memory for the next one.
struct ScanVoxels {
  ScanGrid grid = empty_grid();    ///< What is within range.
  std::vector<VoxelIndex> beyond;  ///< What is occupied beyond it, in the order of the points.
};

/// Steps 1 and 2: what of a scan is occupied, and what it observes on its rays.
/// @param voxels are overwritten
/// @throws DataError for points beyond the common lattice; Cancelled
void find_voxels(const Scan& scan, const Parameters& parameters, const RunContext& context,
                 ScanVoxels& voxels);

/// What two scans occupy beyond their ranges, as far as it lies in the blocks of the first scan's
/// grid or in those around them: by step 3 it may be what is nearest to a voxel within range.
/// @param near is overwritten
void find_beyond(const ScanVoxels& now, const ScanVoxels& before, ScanGrid& near);

}  // namespace raymoval::hmm_mos_method
