// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "methods/dynablox/block_map.h"
#include "methods/dynablox/parameters.h"
#include "methods/dynablox/scan_voxels.h"
#include "methods/dynablox/voxel_kernels.h"
#include "methods/remover.h"

namespace raymoval::dynablox_method {

/// Step 7: which voxels are ever free.
class FreeSpace {
 public:
  explicit FreeSpace(const Parameters& parameters);

  /// Looks at blocks again, when a scan has come and before it is integrated.
  /// @param touched the blocks that the scan before went through
  /// @param hits the voxels in which the scan has points
  void update(const std::vector<Block*>& touched, const VoxelHits& hits, std::int32_t scan,
              const RunContext& context, BlockMap& map) const;

 private:
  /// Step 7a for a block. @param lasting gets the voxels that are to be reset
  void sweep(const VoxelHits& hits, std::int32_t scan, Block& block,
             std::vector<VoxelIndex>& lasting) const;
  /// Whether the voxels of a block that no scan touched are settled by now.
  void settle(std::int32_t scan, Block& block) const;
  void reset(const VoxelIndex& voxel, BlockMap& map) const;
  /// Step 7b for a block.
  void add_ever_free(const BlockMap& map, Block& block) const;
  [[nodiscard]] kernels::Sweep job(std::int32_t scan) const;

  Parameters parameters_;
  kernels::Kernels kernels_;
};

/// How many of the three axes a voxel's neighbours may differ along.
int axes_of(Neighbours neighbours);
/// The 6, 18 or 26 steps to neighbours.
std::vector<VoxelIndex> steps_to(Neighbours neighbours);

}  // namespace raymoval::dynablox_method
