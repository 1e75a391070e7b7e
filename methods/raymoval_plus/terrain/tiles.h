// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <vector>

#include "core/scan/voxel_key.h"
#include "methods/common/dense_blocks.h"

namespace raymoval::raymoval_plus_method {

/// A tile has 2^`kTileBits` columns, 64, along x and y.
inline constexpr int kTileBits = 6;
/// A height of each column, metres. A block is a tile.
using TileHeights = DenseBlocks<float, kTileBits, 0>;
inline constexpr int kTile = TileHeights::kSideXY;

/// The height of the ground where none is known.
inline constexpr float kNoGround = std::numeric_limits<float>::infinity();

/// A rectangle of columns, its corners included.
struct ColumnBox {
  VoxelIndex low, high;
};

/// The tiles that have columns at most `margin` columns from one of the boxes.
VoxelSet tiles_near(const std::vector<ColumnBox>& boxes, int margin);

/// The heights of a tile's columns and of `margin` columns to either side, row by row. Where there
/// is no tile they are `kNoGround`.
std::vector<float> around_tile(const TileHeights& heights, const VoxelIndex& tile, int margin);
/// The columns at least `margin` columns inside of a square, row by row. @param side columns in a
/// row
std::vector<float> middle_of(const std::vector<float>& square, int side, int margin);

}  // namespace raymoval::raymoval_plus_method
