// SPDX-License-Identifier: MIT
#include "methods/mapcleaner/height_grid.h"

#include <algorithm>

namespace raymoval::mapcleaner_method {
namespace {

/// Copies what a window has of a tile.
void copy_tile(const double* heights, const VoxelIndex& from, HeightWindow& window) {
  // The tile's first cell, in cells of the window.
  const int left = from.x() * kTileSide + window.margin, low = from.y() * kTileSide + window.margin;
  const int x_begin = std::max(0, -left), x_end = std::min(kTileSide, window.side - left);
  const int y_begin = std::max(0, -low), y_end = std::min(kTileSide, window.side - low);
  for (int y = y_begin; y < y_end; ++y) {
    for (int x = x_begin; x < x_end; ++x) {
      const double height = heights[y * kTileSide + x];
      if (std::isnan(height)) continue;
      const auto at = static_cast<std::size_t>((low + y) * window.side + left + x);
      if (window.is_empty) window.base = height;
      window.is_empty = false;
      window.height[at] = static_cast<float>(height - window.base);
      window.is_filled[at] = 1.0F;
    }
  }
}

}  // namespace

HeightWindow window_around(const HeightGrid& grid, const VoxelIndex& tile, int margin) {
  HeightWindow window;
  window.margin = margin;
  window.side = kTileSide + 2 * margin;
  const auto cells = static_cast<std::size_t>(window.side) * static_cast<std::size_t>(window.side);
  window.height.assign(cells, 0.0F);
  window.is_filled.assign(cells, 0.0F);
  const int reach = (margin + kTileSide - 1) / kTileSide;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      const std::uint32_t block = grid.block(tile + VoxelIndex(x, y, 0));
      if (block != HeightGrid::kNone) copy_tile(grid.cells(block), {x, y, 0}, window);
    }
  }
  window.is_full =
      std::find(window.is_filled.begin(), window.is_filled.end(), 0.0F) == window.is_filled.end();
  return window;
}

std::vector<VoxelIndex> tiles_around(const HeightGrid& grid, int reach) {
  std::vector<VoxelKey> keys;
  for (std::uint32_t block = 0; block < grid.block_count(); ++block) {
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        keys.push_back(voxel_key(grid.block_index(block) + VoxelIndex(x, y, 0)));
      }
    }
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  std::vector<VoxelIndex> tiles;
  for (const VoxelKey key : keys) tiles.push_back(voxel_index(key));
  return tiles;
}

}  // namespace raymoval::mapcleaner_method
