// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/terrain/terrain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "methods/raymoval_plus/terrain/far_ground.h"
#include "methods/raymoval_plus/terrain/pits.h"

namespace raymoval::raymoval_plus_method {
namespace {

// Numbers of this step.
/// Heights are counted in steps of so many metres, which is less than `ground_height`.
constexpr double kStep = 0.05;
/// A column with fewer points has no ground of its own: they may be false echoes.
constexpr std::uint64_t kLeastPoints = 3;
/// The second round finds columns that were beside another pit.
constexpr int kPitRounds = 2;
/// Columns to either side that this depends on.
constexpr int kPitMargin = kPitRounds * kPitNeighbours;
/// Stacks whose quantiles a thread finds at a time. It changes no answer.
constexpr std::size_t kStacksATask = 64;
/// A distance of three columns of 0.4 m is not to be more than 1.2 m.
constexpr double kReachRounding = 1e-9;

/// Adds a box around the columns of a tile whose values differ, if any do.
template <class Value>
void add_changes(const VoxelIndex& tile, const std::vector<Value>& found, const Value* before,
                 std::vector<ColumnBox>& changes) {
  ColumnBox box{VoxelIndex(kTile, kTile, 0), VoxelIndex(-1, -1, 0)};
  for (int y = 0; y < kTile; ++y) {
    for (int x = 0; x < kTile; ++x) {
      const auto i = static_cast<std::size_t>(y * kTile + x);
      if (found[i] == before[i]) continue;
      box.low = box.low.cwiseMin(VoxelIndex(x, y, 0));
      box.high = box.high.cwiseMax(VoxelIndex(x, y, 0));
    }
  }
  if (box.high.x() >= 0) changes.push_back({box.low + tile * kTile, box.high + tile * kTile});
}

/// Writes what is found of each of some tiles. @return where it is other than before
/// @param find gives the values of a tile's columns, row by row
template <class Value, class Find>
std::vector<ColumnBox> fill_tiles(const VoxelSet& tiles, const RunContext& context,
                                  DenseBlocks<Value, kTileBits, 0>& values, Find&& find) {
  std::vector<VoxelKey> keys(tiles.begin(), tiles.end());
  std::sort(keys.begin(), keys.end());
  std::vector<std::vector<Value>> found(keys.size());
  parallel_for(context.threads, keys.size(), 1,
               [&](std::size_t i) { found[i] = find(voxel_index(keys[i])); });
  typename DenseBlocks<Value, kTileBits, 0>::Cursor cursor;
  std::vector<ColumnBox> changes;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const VoxelIndex tile = voxel_index(keys[i]);
    Value* const kept = &values.make(tile * kTile, cursor);
    add_changes(tile, found[i], kept, changes);
    std::copy(found[i].begin(), found[i].end(), kept);
  }
  return changes;
}

/// Where in its column, of 256 parts, a point is: columns from the middle.
float from_middle(std::uint32_t part) {
  return (static_cast<float>(part) + 0.5F) / 256.0F - 0.5F;
}

}  // namespace

Terrain::Terrain(const Parameters& parameters)
    : parameters_(parameters),
      inverse_cell_(1.0 / parameters.terrain_cell),
      reach_(
          static_cast<int>(std::floor(parameters.terrain_reach * inverse_cell_ + kReachRounding))),
      counts_(0),
      own_ground_(kNoGround),
      land_x_(kNoGround),
      land_y_(kNoGround),
      ground_(GroundPlane{-kNoGround}) {}

void Terrain::find_cells_of(const Scan& scan, int threads, ScanCells& cells) const {
  find_cells(scan, {inverse_cell_, inverse_cell_, 1.0 / kStep}, BesideCells::kPartsAndHeight,
             threads, cells);
}

void Terrain::add(const ScanCells& cells, const RunContext& context) {
  const StageScope timed(context.times, "terrain");
  Counts::Cursor cursor;
  std::uint32_t last = Counts::kNone;
  std::array<std::size_t, kPointsAtOnce> slots;
  for (std::size_t begin = 0; begin < cells.size(); begin += kPointsAtOnce) {
    const std::size_t count = std::min(kPointsAtOnce, cells.size() - begin);
    for (std::size_t i = 0; i < count; ++i) {
      slots[i] = counts_.make_slot(cells[begin + i], cursor);
      __builtin_prefetch(&counts_.at(slots[i]), 1);
      if (cursor.block != last) note_change(cursor.block);
      last = cursor.block;
    }
    for (std::size_t i = 0; i < count; ++i) ++counts_.at(slots[i]);
  }
}

void Terrain::note_change(std::uint32_t block) {
  if (has_news_.size() < counts_.block_count()) has_news_.resize(counts_.block_count(), 0);
  if (std::exchange(has_news_[block], std::uint8_t{1}) == 0) {
    mark_changed(counts_.block_index(block));
  }
}

void Terrain::mark_changed(const VoxelIndex& block) {
  const VoxelKey key = voxel_key(block.x(), block.y(), 0);
  Stack& stack = stacks_.emplace(key, Stack{block.z(), block.z()}).first.value();
  stack.low = std::min(stack.low, block.z());
  stack.high = std::max(stack.high, block.z());
  if (!std::exchange(stack.is_stale, true)) stale_.push_back(key);
  const VoxelIndex corner = block * Counts::kSideXY,
                   margin(kPitMargin + reach_, kPitMargin + reach_, 0);
  const VoxelIndex low = TileHeights::block_of(corner - margin);
  const VoxelIndex high =
      TileHeights::block_of(corner.array() + Counts::kSideXY - 1 + margin.array());
  for (int y = low.y(); y <= high.y(); ++y) {
    for (int x = low.x(); x <= high.x(); ++x) changed_.insert(voxel_key(x, y, 0));
  }
}

void Terrain::find_low_quantiles(const VoxelIndex& block, Stack& stack) const {
  std::vector<std::pair<int, const std::uint32_t*>> blocks;  // The lowest first.
  for (int z = stack.low; z <= stack.high; ++z) {
    const std::uint32_t number = counts_.block({block.x(), block.y(), z});
    if (number != Counts::kNone) blocks.emplace_back(z * Counts::kSideZ, counts_.cells(number));
  }
  for (std::size_t c = 0; c < kStackColumns; ++c) {
    std::uint64_t points = 0;
    for (const auto& [z, cells] : blocks) {
      for (std::size_t k = 0; k < Counts::kSideZ; ++k) points += cells[k * kStackColumns + c];
    }
    if (points < kLeastPoints) continue;
    const double wanted = parameters_.terrain_quantile * static_cast<double>(points);
    std::uint64_t below = 0;
    float ground = kNoGround;
    for (auto level = blocks.begin(); level != blocks.end() && ground == kNoGround; ++level) {
      for (std::size_t k = 0; k < Counts::kSideZ; ++k) {
        const std::uint32_t count = level->second[k * kStackColumns + c];
        if (count != 0 && static_cast<double>(below + count) >= wanted) {
          const double share = (wanted - static_cast<double>(below)) / count;
          ground = static_cast<float>((level->first + static_cast<int>(k) + share) * kStep);
          break;
        }
        below += count;
      }
    }
    stack.ground[c] = ground;
  }
}

Terrain::Window Terrain::low_quantiles(const VoxelIndex& tile, int margin) const {
  const int side = kTile + 2 * margin;
  Window window(static_cast<std::size_t>(side * side), kNoGround);
  const int left = tile.x() * kTile - margin, bottom = tile.y() * kTile - margin;
  const VoxelIndex low = Counts::block_of({left, bottom, 0});
  const VoxelIndex high = Counts::block_of({left + side - 1, bottom + side - 1, 0});
  for (int v = low.y(); v <= high.y(); ++v) {
    for (int u = low.x(); u <= high.x(); ++u) {
      const auto stack = stacks_.find(voxel_key(u, v, 0));
      if (stack == stacks_.end()) continue;
      for (std::size_t c = 0; c < kStackColumns; ++c) {
        const int x = u * Counts::kSideXY + static_cast<int>(c) % Counts::kSideXY - left;
        const int y = v * Counts::kSideXY + static_cast<int>(c) / Counts::kSideXY - bottom;
        if (x < 0 || y < 0 || x >= side || y >= side) continue;
        window[static_cast<std::size_t>(y * side + x)] = stack->second.ground[c];
      }
    }
  }
  return window;
}

Terrain::Window Terrain::without_pits_in(const VoxelIndex& tile) const {
  Window ground = low_quantiles(tile, kPitMargin);
  for (int round = 0; round < kPitRounds; ++round) {
    ground =
        without_pits(ground, kTile + 2 * kPitMargin, static_cast<float>(parameters_.terrain_drop));
  }
  return middle_of(ground, kTile + 2 * kPitMargin, kPitMargin);
}

Terrain::Window Terrain::land_in(const VoxelIndex& tile, int axis) const {
  const Window ground = around_tile(own_ground_, tile, kLandMargin);
  constexpr int kSide = kTile + 2 * kLandMargin;
  return middle_of(land_rise(ground, kSide, axis), kSide, kLandMargin);
}

int Terrain::bound_margin() const {
  return kFarReach + reach_;
}

std::vector<GroundPlane> Terrain::ground_in(const VoxelIndex& tile) const {
  const int margin = bound_margin();
  Window ground = around_tile(own_ground_, tile, margin);
  const Window rises =
      highest_rises(around_tile(land_x_, tile, margin), around_tile(land_y_, tile, margin),
                    parameters_.terrain_cell, parameters_.terrain_far_slope);
  ground = bounded_from_afar(ground, rises, kTile + 2 * margin);
  const Window rise_x = around_tile(land_x_, tile, 0), rise_y = around_tile(land_y_, tile, 0);
  std::vector<GroundPlane> planes(rise_x.size());
  for (std::size_t i = 0; i < planes.size(); ++i) {
    planes[i] = steep_part(rise_x[i], rise_y[i], parameters_.terrain_cell);
  }
  bound_by_slope(ground, planes);
  return planes;
}

void Terrain::bound_by_slope(const Window& ground, std::vector<GroundPlane>& planes) const {
  const int side = kTile + 2 * reach_;
  // Columns without points of their own take the ground from beside them.
  Window lowest(planes.size(), kNoGround);
  for (int dy = -reach_; dy <= reach_; ++dy) {
    for (int dx = -reach_; dx <= reach_; ++dx) {
      const double distance = std::hypot(dx, dy) * parameters_.terrain_cell;
      if (distance > parameters_.terrain_reach + kReachRounding) continue;
      const auto rise = static_cast<float>(parameters_.terrain_slope * distance);
      const auto x_back = static_cast<float>(-dx), y_back = static_cast<float>(-dy);
      for (int y = 0; y < kTile; ++y) {
        const float* const from = ground.data() + (y + reach_ + dy) * side + reach_ + dx;
        float* const to = lowest.data() + y * kTile;
        const GroundPlane* const plane = planes.data() + y * kTile;
        for (int x = 0; x < kTile; ++x) {
          const float of_land = x_back * plane[x].rise_x + y_back * plane[x].rise_y;
          to[x] = std::min(to[x], from[x] + (rise + of_land));
        }
      }
    }
  }
  for (std::size_t i = 0; i < planes.size(); ++i) {
    // Any height is far above no ground.
    planes[i].middle =
        lowest[i] < kNoGround
            ? lowest[i] + quantile_below_middle(planes[i], parameters_.terrain_quantile)
            : -kNoGround;
  }
}

void Terrain::update_low_quantiles(const RunContext& context) {
  parallel_for(context.threads, stale_.size(), kStacksATask, [&](std::size_t i) {
    Stack& stack = stacks_.find(stale_[i]).value();
    find_low_quantiles(voxel_index(stale_[i]), stack);
    stack.is_stale = false;
  });
  stale_.clear();
}

VoxelSet Terrain::tiles_to_find(const std::vector<ColumnBox>& changes, int margin,
                                const VoxelSet& fresh) const {
  VoxelSet found = fresh;
  for (const VoxelKey tile : tiles_near(changes, margin)) {
    if (tiles_.contains(tile)) found.insert(tile);
  }
  return found;
}

void Terrain::update(const RunContext& context) {
  const StageScope timed(context.times, "terrain");
  update_low_quantiles(context);
  std::fill(has_news_.begin(), has_news_.end(), std::uint8_t{0});
  const VoxelSet tiles = std::exchange(changed_, {});
  VoxelSet fresh;
  for (const VoxelKey tile : tiles) {
    if (tiles_.insert(tile).second) fresh.insert(tile);
  }
  // What has not changed changes nothing around it.
  std::vector<ColumnBox> changes =
      fill_tiles(tiles, context, own_ground_,
                 [this](const VoxelIndex& tile) { return without_pits_in(tile); });
  const VoxelSet of_land = tiles_to_find(changes, kLandMargin, fresh);
  for (const auto& [land, axis] : {std::pair(&land_x_, 0), std::pair(&land_y_, 1)}) {
    const std::vector<ColumnBox> more =
        fill_tiles(of_land, context, *land,
                   [this, axis = axis](const VoxelIndex& tile) { return land_in(tile, axis); });
    changes.insert(changes.end(), more.begin(), more.end());
  }
  fill_tiles(tiles_to_find(changes, bound_margin(), fresh), context, ground_,
             [this](const VoxelIndex& tile) { return ground_in(tile); });
}

void Terrain::find_heights(const ScanCells& cells, const RunContext& context,
                           std::vector<float>& heights) const {
  heights.resize(cells.size());
  parallel_chunks(
      context.threads, cells.size(), kPointsATask, [&](std::size_t begin, std::size_t end) {
        decltype(ground_)::Cursor cursor;
        for (std::size_t k = begin; k < end; ++k) {
          const GroundPlane plane = ground_.get({cells.x[k], cells.y[k], 0}, cursor);
          const float x = from_middle(cells.parts[k] & 0xFFU);
          const float y = from_middle(cells.parts[k] >> 8U & 0xFFU);
          heights[k] = cells.height[k] - (plane.middle + (plane.rise_x * x + plane.rise_y * y));
        }
      });
}

}  // namespace raymoval::raymoval_plus_method
