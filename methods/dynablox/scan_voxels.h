// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/scan/scan.h"
#include "methods/dynablox/block_map.h"

namespace raymoval::dynablox_method {

/// Voxels in which a scan has points.
class VoxelHits {
 public:
  void clear() {
    numbers_.clear();
    blocks_.clear();
  }
  void add(const VoxelIndex& voxel);
  /// The voxels of the block at these block indices, or null.
  [[nodiscard]] const BlockBits* find(const VoxelIndex& at) const {
    const auto found = numbers_.find(voxel_key(at));
    return found == numbers_.end() ? nullptr : &blocks_[found->second];
  }
  [[nodiscard]] bool contains(const VoxelIndex& voxel) const {
    const BlockBits* block = find(block_of(voxel));
    return block != nullptr && ((*block)[row_of(voxel)] & bit_of(voxel)) != 0;
  }

 private:
  VoxelMap<std::uint32_t> numbers_;
  std::vector<BlockBits> blocks_;
  VoxelIndex last_at_ = VoxelIndex::Zero();  ///< The block that was asked for last,
  std::uint32_t last_ = 0;                   ///< and its number.
};

/// The voxels of a scan's points.
struct ScanVoxels {
  std::vector<std::uint32_t> points;  ///< Those that take part.
  std::vector<VoxelIndex> voxels;     ///< The voxel of each of them.
  VoxelHits hits;
};

/// Steps 1 and 2. @param min_range, max_range of points that take part, metres, ends included
void find_voxels(const Scan& scan, double voxel_size, double min_range, double max_range,
                 ScanVoxels& found);

}  // namespace raymoval::dynablox_method
