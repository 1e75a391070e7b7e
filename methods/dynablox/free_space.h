// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "methods/dynablox/dynablox.h"
#include "methods/dynablox/voxel_kernels.h"
#include "methods/dynablox/voxels.h"
#include "methods/remover.h"

namespace raymoval::dynablox_method {

/// Step 7: which voxels are ever free.
class FreeSpace {
 public:
  explicit FreeSpace(const Parameters& parameters)
      : parameters_(parameters), kernels_(kernels::best_kernels()) {}

  /// Looks at blocks again, when a scan has come and before it is integrated.
  /// @param touched the blocks that the scan before went through
  /// @param hits the voxels in which the scan has points
  void update(const std::vector<Block*>& touched, const SparseBlocks<BlockBits>& hits,
              std::int32_t scan, const RunContext& context, BlockMap& map) const;

 private:
  /// Finds the settled voxels of a block.
  /// @param is_touched whether the scan before went through it, so that it is seen which voxels are
  /// occupied
  /// @return the voxels that are to be reset
  std::vector<VoxelIndex> sweep(const BlockBits* hit, bool is_touched, std::int32_t scan,
                                Block& block) const;
  void add_ever_free(const BlockMap& map, Block& block) const;

  Parameters parameters_;
  kernels::Kernels kernels_;
};

}  // namespace raymoval::dynablox_method
