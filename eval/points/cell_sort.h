// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/scan/voxel_key.h"

namespace raymoval {

/// A point and the cell in which it lies.
struct CellPoint {
  VoxelKey key;
  std::uint32_t point;
};

/// Sorts by key; points of one cell keep their order.
void sort_by_cell(std::vector<CellPoint>& points);

}  // namespace raymoval
