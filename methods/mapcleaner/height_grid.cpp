// SPDX-License-Identifier: MIT
#include "methods/mapcleaner/terrain.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/angle.h"
#include "core/parallel.h"

namespace raymoval::mapcleaner_method {
namespace {

/// A square of cells around a tile, row by row. Heights are relative to `base`, so that single
/// precision holds them.
struct HeightWindow {
  int margin = 0, side = 0;
  double base = 0.0;             ///< The first height of the window, metres.
  std::vector<float> height;     ///< 0 where there is none.
  std::vector<float> is_filled;  ///< 1 where there is a height, else 0.
  bool is_empty = true;
  bool is_full = true;

  /// The index of the tile's cell (x, y), which may be up to `margin` outside.
  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>((y + margin) * side + margin + x);
  }
};

/// Copies the part of a tile that is in the window.
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

/// @param tile block indices
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

/// Block indices of all tiles of `grid` and of those at most `reach` tiles from one, sorted.
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

/// A cell at the distance of the radius, within rounding, is not nearer.
constexpr double kRounding = 1e-9;

using Row = std::array<float, kTileSide>;

/// A cell around another one, and its weight.
struct Tap {
  int x, y;
  float weight;
};

std::vector<Tap> taps_within(double radius) {
  std::vector<Tap> taps;
  const int reach = static_cast<int>(radius);
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      const double d = std::sqrt(x * x + y * y) / radius;
      if (d > 1.0 - kRounding) continue;
      const double weight =
          (2.0 + std::cos(kTurn * d)) / 3.0 * (1.0 - d) + std::sin(kTurn * d) / kTurn;
      taps.push_back({x, y, static_cast<float>(weight)});
    }
  }
  return taps;
}

/// For each row of a window, whether it has heights.
std::vector<std::uint8_t> rows_with_heights(const HeightWindow& window) {
  std::vector<std::uint8_t> rows(static_cast<std::size_t>(window.side), 0);
  for (std::size_t y = 0; y < rows.size(); ++y) {
    const auto begin = window.is_filled.begin() + static_cast<std::ptrdiff_t>(y) * window.side;
    rows[y] = std::find(begin, begin + window.side, 1.0F) != begin + window.side ? 1 : 0;
  }
  return rows;
}

/// Calls `add(tap, place of the row's first tap in the window)` for the taps of a tile's row that
/// may have heights.
template <class Add>
void for_taps_of_row(const std::vector<Tap>& taps, const HeightWindow& window,
                     const std::vector<std::uint8_t>& rows, int y, Add&& add) {
  for (const Tap& tap : taps) {
    if (rows[static_cast<std::size_t>(y + tap.y + window.margin)] == 0) continue;
    add(tap.weight, window.at(tap.x, y + tap.y));
  }
}

/// First round: the smooth heights of a tile.
void find_smooth_heights(const HeightWindow& window, const std::vector<Tap>& taps, int least_cells,
                         double* smooth) {
  const std::vector<std::uint8_t> rows = rows_with_heights(window);
  for (int y = 0; y < kTileSide; ++y) {
    Row sum{}, weights{}, cells{};
    for_taps_of_row(taps, window, rows, y, [&](float weight, std::size_t at) {
      const float* const height = window.height.data() + at;
      const float* const is_filled = window.is_filled.data() + at;
      for (std::size_t x = 0; x < kTileSide; ++x) {
        sum[x] += weight * height[x];
        weights[x] += weight * is_filled[x];
        cells[x] += is_filled[x];
      }
    });
    for (std::size_t x = 0; x < kTileSide; ++x, ++smooth) {
      if (cells[x] < static_cast<float>(least_cells) || !(weights[x] > 0.0F)) continue;
      *smooth = window.base + static_cast<double>(sum[x] / weights[x]);
    }
  }
}

/// The smallest weight of a cell far from its smooth height is exp(-kMostAway), about 1e-26. A
/// smaller weight times the kernel would be 0 in single precision, and a cell with only such
/// neighbours would have no height.
constexpr double kMostAway = 60.0;

/// Weighs the cells of a window by their deviation from their smooth heights: the weights are
/// stored in `is_filled`, the weighted heights in `height`.
void weigh_by_deviation(const HeightWindow& smooth, double deviation, HeightWindow& window) {
  const double scale = 0.5 / (deviation * deviation);
  for (std::size_t i = 0; i < window.height.size(); ++i) {
    if (window.is_filled[i] == 0.0F) continue;
    const double away = (window.base + static_cast<double>(window.height[i])) -
                        (smooth.base + static_cast<double>(smooth.height[i]));
    const double weight =
        smooth.is_filled[i] == 0.0F ? 0.0 : std::exp(-std::min(away * away * scale, kMostAway));
    window.is_filled[i] = static_cast<float>(weight);
    window.height[i] *= static_cast<float>(weight);
  }
}

/// Second round: the heights of a tile's cells with a smooth height only.
void fill_tile(const HeightWindow& window, const std::vector<Tap>& taps, const double* smooth,
               double* heights) {
  const std::vector<std::uint8_t> all(static_cast<std::size_t>(window.side), 1);
  for (int y = 0; y < kTileSide; ++y) {
    Row sum{}, weights{};
    for_taps_of_row(taps, window, all, y, [&](float weight, std::size_t at) {
      const float* const height = window.height.data() + at;
      const float* const counts = window.is_filled.data() + at;
      for (std::size_t x = 0; x < kTileSide; ++x) {
        sum[x] += weight * height[x];
        weights[x] += weight * counts[x];
      }
    });
    for (std::size_t x = 0; x < kTileSide; ++x, ++smooth, ++heights) {
      if (!std::isnan(*heights) || std::isnan(*smooth) || !(weights[x] > 0.0F)) continue;
      *heights = window.base + static_cast<double>(sum[x] / weights[x]);
    }
  }
}

/// A grid with these tiles, without heights.
HeightGrid grid_of(const std::vector<VoxelIndex>& tiles) {
  HeightGrid grid(kNoHeight);
  HeightGrid::Cursor cursor;
  for (const VoxelIndex& tile : tiles) grid.make(tile * kTileSide, cursor);
  return grid;
}

double* cells_of(HeightGrid& grid, std::size_t block) {
  return &grid.at(block * HeightGrid::kCells);
}

}  // namespace

HeightGrid filled(const HeightGrid& grid, const Fill& fill, int threads) {
  if (!(fill.radius > 0.0)) return grid;
  const std::vector<Tap> taps = taps_within(fill.radius);
  const int margin = static_cast<int>(fill.radius);
  const std::vector<VoxelIndex> tiles = tiles_around(grid, (margin + kTileSide - 1) / kTileSide);
  HeightGrid smooth = grid_of(tiles);
  parallel_for(threads, tiles.size(), 1, [&](std::size_t i) {
    const HeightWindow window = window_around(grid, tiles[i], margin);
    if (window.is_empty || window.is_full) return;  // Not needed there.
    find_smooth_heights(window, taps, fill.least_cells, cells_of(smooth, i));
  });
  HeightGrid result = grid_of(tiles);
  parallel_for(threads, tiles.size(), 1, [&](std::size_t i) {
    double* const heights = cells_of(result, i);
    const std::uint32_t own = grid.block(tiles[i]);
    if (own != HeightGrid::kNone) std::copy_n(grid.cells(own), HeightGrid::kCells, heights);
    const auto number = static_cast<std::uint32_t>(i);
    const double* const of_tile = smooth.cells(number);
    const bool is_wanted = std::any_of(of_tile, of_tile + HeightGrid::kCells,
                                       [](double height) { return !std::isnan(height); });
    if (!is_wanted) return;
    HeightWindow window = window_around(grid, tiles[i], margin);
    weigh_by_deviation(window_around(smooth, tiles[i], margin), fill.deviation, window);
    fill_tile(window, taps, of_tile, heights);
  });
  return result;
}

}  // namespace raymoval::mapcleaner_method
