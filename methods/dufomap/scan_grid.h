// SPDX-License-Identifier: MIT
#pragma once

#include "methods/common/column_grid.h"

namespace raymoval::dufomap_method {

using namespace column_blocks;

/// What one scan says of a column of voxels. Each voxel has a bit, the lowest voxel the lowest bit.
struct Column {
  std::uint64_t free = 0;  ///< The set F of step 3.
  std::uint64_t hit = 0;   ///< The set H of step 2.
};

using ScanBlock = ColumnBlock<Column>;

/// The hits and the free voxels of one scan.
class ScanGrid : public ColumnGrid<Column> {
 public:
  ScanGrid()
      : ColumnGrid("dufomap", "Set dufomap.maximum_range, or a larger dufomap.voxel_size.") {}
};

}  // namespace raymoval::dufomap_method
