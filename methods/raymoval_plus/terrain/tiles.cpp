// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/terrain/tiles.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace raymoval::raymoval_plus_method {
namespace {

/// So many tiles have columns at most `margin` columns from a tile, to either side.
int tiles_within(int margin) {
  return (margin + kTile - 1) / kTile;
}

}  // namespace

VoxelSet tiles_near(const std::vector<ColumnBox>& boxes, int margin) {
  VoxelSet near;
  const VoxelIndex wider(margin, margin, 0);
  for (const ColumnBox& box : boxes) {
    const VoxelIndex low = TileHeights::block_of(box.low - wider);
    const VoxelIndex high = TileHeights::block_of(box.high + wider);
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int x = low.x(); x <= high.x(); ++x) near.insert(voxel_key(x, y, 0));
    }
  }
  return near;
}

std::vector<float> around_tile(const TileHeights& heights, const VoxelIndex& tile, int margin) {
  const int side = kTile + 2 * margin, reach = tiles_within(margin);
  std::vector<float> around(static_cast<std::size_t>(side * side), kNoGround);
  for (int v = -reach; v <= reach; ++v) {
    for (int u = -reach; u <= reach; ++u) {
      const std::uint32_t block = heights.block(tile + VoxelIndex(u, v, 0));
      if (block == TileHeights::kNone) continue;
      // Where the block's lower corner is in the square, and what of the block lies in it.
      const int left = u * kTile + margin, bottom = v * kTile + margin;
      const int begin = std::max(0, -left), end = std::min(kTile, side - left);
      for (int y = std::max(0, -bottom); y < std::min(kTile, side - bottom); ++y) {
        std::copy_n(heights.cells(block) + y * kTile + begin, end - begin,
                    around.data() + (bottom + y) * side + left + begin);
      }
    }
  }
  return around;
}

std::vector<float> middle_of(const std::vector<float>& square, int side, int margin) {
  std::vector<float> middle;
  for (int y = margin; y < side - margin; ++y) {
    const float* const row = square.data() + y * side;
    middle.insert(middle.end(), row + margin, row + side - margin);
  }
  return middle;
}

}  // namespace raymoval::raymoval_plus_method
