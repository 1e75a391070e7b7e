// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "methods/common/scan_grid.h"
#include "methods/common/sparse_blocks.h"

namespace raymoval::dufomap_method {

using namespace scan_grid;  // Its blocks and columns.

/// Void voxels of a block, a word for each column.
using VoidBits = std::array<std::uint64_t, kColumns>;

/// Void voxels of one scan by block.
using ScanVoids = std::vector<std::pair<VoxelIndex, VoidBits>>;

/// Step 4: voxels that are not hit and whose (2 d_p + 1)^3 neighbourhood is all free.
/// @param inflation d_p, voxels, at most a block's side
void find_voids(const ScanGrid& grid, int inflation, ScanVoids& voids);

/// Step 5: the voids of all scans so far, 8 KiB a block of 32 x 32 x 64 voxels.
class VoidMap {
 public:
  void add(const ScanVoids& voids);
  /// 1 for each voxel that is a void.
  [[nodiscard]] std::vector<std::uint8_t> contain(const std::vector<VoxelIndex>& voxels) const;

 private:
  SparseBlocks<VoidBits> blocks_;
};

}  // namespace raymoval::dufomap_method
