// SPDX-License-Identifier: MIT
#include "methods/dufomap/beams.h"

#include <algorithm>

namespace raymoval::dufomap_method {
namespace {

constexpr int kMostInflation = 8;
constexpr int kWidest = kSide + 2 * kMostInflation;
/// Columns of a block and of its surroundings within d_p; row = x.
using Padded = std::array<std::array<std::uint64_t, kWidest>, kWidest>;

/// Voxels of a column whose neighbours up to `inflation` below and above are free.
std::uint64_t erode_upright(std::uint64_t below, std::uint64_t column, std::uint64_t above,
                            int inflation) {
  std::uint64_t eroded = column;
  for (int k = 1; k <= inflation; ++k) {
    eroded &= (column << k) | (below >> (kHeight - k));
    eroded &= (column >> k) | (above << (kHeight - k));
  }
  return eroded;
}

/// First and past-the-last column along one axis that a neighbour block at offset `d` (-1, 0, +1)
/// adds.
std::pair<int, int> columns_added(int d, int inflation) {
  if (d < 0) return {-inflation, 0};
  return d > 0 ? std::pair(kSide, kSide + inflation) : std::pair(0, kSide);
}

/// Writes the block at offset (dx, dy) from `at`, eroded along z, into its part of `padded`.
/// @return false if that is all zero
bool add_neighbour(const ScanGrid& grid, const VoxelIndex& at, int dx, int dy, int inflation,
                   Padded& padded) {
  static const ScanBlock kNothing{};
  const auto block_at = [&](int dz) -> const ScanBlock& {
    const ScanBlock* block = grid.find(at + VoxelIndex(dx, dy, dz));
    return block == nullptr ? kNothing : *block;
  };
  const ScanBlock &block = block_at(0), &below = block_at(-1), &above = block_at(1);
  const auto [x_first, x_end] = columns_added(dx, inflation);
  const auto [y_first, y_end] = columns_added(dy, inflation);
  std::uint64_t any = 0;
  for (int x = x_first; x < x_end; ++x) {
    auto& row = padded[static_cast<std::size_t>(x + inflation)];
    for (int y = y_first; y < y_end; ++y) {
      const std::size_t column = column_of({x, y, 0});
      const std::uint64_t eroded =
          erode_upright(below.columns[column].free, block.columns[column].free,
                        above.columns[column].free, inflation);
      row[static_cast<std::size_t>(y + inflation)] = eroded;
      any |= eroded;
    }
  }
  return any != 0;
}

/// Replaces each row by the AND of `2 * inflation + 1` rows, itself the first of them.
void erode_along_x(Padded& padded, int inflation) {
  const auto width = static_cast<std::size_t>(kSide + 2 * inflation);
  for (std::size_t x = 0; x < kSide; ++x) {
    for (std::size_t k = 1; k <= static_cast<std::size_t>(2 * inflation); ++k) {
      for (std::size_t y = 0; y < width; ++y) padded[x][y] &= padded[x + k][y];
    }
  }
}

/// Erodes along y and stores the voids of a block. @return false if none is left
bool erode_along_y(const Padded& padded, int inflation, const ScanBlock& block, VoidBits& voids) {
  std::uint64_t any = 0;
  for (std::size_t x = 0; x < kSide; ++x) {
    for (std::size_t y = 0; y < kSide; ++y) {
      const std::size_t column = x * kSide + y;
      std::uint64_t bits = ~block.columns[column].hit;
      for (std::size_t k = 0; k <= static_cast<std::size_t>(2 * inflation); ++k) {
        bits &= padded[x][y + k];
      }
      voids[column] = bits;
      any |= bits;
    }
  }
  return any != 0;
}

}  // namespace

void find_voids(const ScanGrid& grid, int inflation, ScanVoids& voids) {
  voids.clear();
  Padded padded;
  VoidBits bits{};
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const ScanBlock& block = grid[i];
    if (!add_neighbour(grid, block.at, 0, 0, inflation, padded)) continue;
    for (int side = 0; side < 9; ++side) {
      const int dx = side / 3 - 1, dy = side % 3 - 1;
      if (side != 4) add_neighbour(grid, block.at, dx, dy, inflation, padded);
    }
    erode_along_x(padded, inflation);
    if (erode_along_y(padded, inflation, block, bits)) {
      voids.emplace_back(block.at, bits);
    }
  }
}

void VoidMap::add(const ScanVoids& voids) {
  for (const auto& [at, bits] : voids) {
    VoidBits& block = blocks_.find_or_make(at);
    for (std::size_t column = 0; column < kColumns; ++column) block[column] |= bits[column];
  }
}

std::vector<std::uint8_t> VoidMap::contain(const std::vector<VoxelIndex>& voxels) const {
  std::vector<std::uint8_t> inside(voxels.size(), 0);
  BlockFinder blocks(blocks_);
  for (std::size_t k = 0; k < voxels.size(); ++k) {
    const VoidBits* block = blocks.find(block_of(voxels[k]));
    if (block == nullptr) continue;
    inside[k] = ((*block)[column_of(voxels[k])] & bit_of(voxels[k])) != 0 ? 1 : 0;
  }
  return inside;
}

}  // namespace raymoval::dufomap_method
