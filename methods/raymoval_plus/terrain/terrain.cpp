// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/terrain/terrain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/parallel.h"

namespace raymoval::raymoval_plus_method {
namespace {

// Numbers of this step. EXPERIMENTS.md has kStep and kNeighbours at half and at double their
// values.
/// Heights are counted in steps of so many metres, which is less than `ground_height`.
constexpr double kStep = 0.05;
/// A column with fewer points has no ground of its own: they may be false echoes.
constexpr std::uint64_t kLeastPoints = 3;
/// A column is compared with those around it, so many to either side: 3.6 m across, more than a pit
/// of false echoes is wide. With fewer than `kLeastNeighbours` that have ground it is dropped.
constexpr int kNeighbours = 4, kLeastNeighbours = 4;
/// The second round finds columns that were beside another pit.
constexpr int kPitRounds = 2;
/// A distance of three columns of 0.4 m is not to be more than 1.2 m.
constexpr double kRounding = 1e-9;
constexpr float kNoGround = std::numeric_limits<float>::infinity();

}  // namespace

Terrain::Terrain(const Parameters& parameters)
    : parameters_(parameters),
      inverse_cell_(1.0 / parameters.terrain_cell),
      reach_(static_cast<int>(std::floor(parameters.terrain_reach * inverse_cell_ + kRounding))),
      margin_(kPitRounds * kNeighbours + reach_),
      side_(kTile + 2 * margin_),
      counts_(0),
      ground_(-kNoGround) {}

void Terrain::find_cells_of(const Scan& scan, int threads, ScanCells& cells) const {
  find_cells(scan, {inverse_cell_, inverse_cell_, 1.0 / kStep}, BesideCells::kHeight, threads,
             cells);
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
  const auto [extent, fresh] =
      extents_.emplace(voxel_key(block.x(), block.y(), 0), std::pair{block.z(), block.z()});
  extent.value().first = std::min(extent->second.first, block.z());
  extent.value().second = std::max(extent->second.second, block.z());
  const VoxelIndex corner = block * Counts::kSideXY, margin(margin_, margin_, 0);
  const VoxelIndex low = Heights::block_of(corner - margin);
  const VoxelIndex high = Heights::block_of(corner.array() + Counts::kSideXY - 1 + margin.array());
  for (int y = low.y(); y <= high.y(); ++y) {
    for (int x = low.x(); x <= high.x(); ++x) changed_.insert(voxel_key(x, y, 0));
  }
}

Terrain::Window Terrain::low_quantiles(const VoxelIndex& tile) const {
  Window window(static_cast<std::size_t>(side_ * side_), kNoGround);
  const int left = tile.x() * kTile - margin_, bottom = tile.y() * kTile - margin_;
  const VoxelIndex low = Counts::block_of({left, bottom, 0});
  const VoxelIndex high = Counts::block_of({left + side_ - 1, bottom + side_ - 1, 0});
  for (int y = low.y(); y <= high.y(); ++y) {
    for (int x = low.x(); x <= high.x(); ++x) {
      const auto extent = extents_.find(voxel_key(x, y, 0));
      if (extent == extents_.end()) continue;
      fill_quantiles({x, y, 0}, extent->second.first, extent->second.second, left, bottom, window);
    }
  }
  return window;
}

void Terrain::fill_quantiles(const VoxelIndex& block, int low_z, int high_z, int left, int bottom,
                             Window& window) const {
  constexpr std::size_t kColumns = std::size_t{Counts::kSideXY} * Counts::kSideXY;
  std::vector<std::pair<int, const std::uint32_t*>> stack;  // Blocks, the lowest first.
  for (int z = low_z; z <= high_z; ++z) {
    const std::uint32_t number = counts_.block({block.x(), block.y(), z});
    if (number != Counts::kNone) stack.emplace_back(z * Counts::kSideZ, counts_.cells(number));
  }
  for (std::size_t c = 0; c < kColumns; ++c) {
    const int x = block.x() * Counts::kSideXY + static_cast<int>(c) % Counts::kSideXY - left;
    const int y = block.y() * Counts::kSideXY + static_cast<int>(c) / Counts::kSideXY - bottom;
    if (x < 0 || y < 0 || x >= side_ || y >= side_) continue;
    std::uint64_t points = 0;
    for (const auto& [z, cells] : stack) {
      for (std::size_t k = 0; k < Counts::kSideZ; ++k) points += cells[k * kColumns + c];
    }
    if (points < kLeastPoints) continue;
    const double wanted = parameters_.terrain_quantile * static_cast<double>(points);
    std::uint64_t below = 0;
    float& ground = window[static_cast<std::size_t>(y * side_ + x)];
    for (auto level = stack.begin(); level != stack.end() && ground == kNoGround; ++level) {
      for (std::size_t k = 0; k < Counts::kSideZ; ++k) {
        const std::uint32_t count = level->second[k * kColumns + c];
        if (count != 0 && static_cast<double>(below + count) >= wanted) {
          const double share = (wanted - static_cast<double>(below)) / count;
          ground = static_cast<float>((level->first + static_cast<int>(k) + share) * kStep);
          break;
        }
        below += count;
      }
    }
  }
}

Terrain::Window Terrain::without_pits(const Window& ground) const {
  Window kept(ground.size(), kNoGround);
  const auto side = static_cast<std::size_t>(side_);
  std::vector<float> highest(side);  // A column around may be as high as this.
  std::vector<int> around(side), not_above(side);
  for (int y = 0; y < side_; ++y) {
    const float* const values = ground.data() + static_cast<std::size_t>(y) * side;
    const auto drop = static_cast<float>(parameters_.terrain_drop);
    std::transform(values, values + side, highest.begin(), [&](float z) { return z + drop; });
    std::fill(around.begin(), around.end(), 0);
    std::fill(not_above.begin(), not_above.end(), 0);
    for (int v = std::max(y - kNeighbours, 0); v <= std::min(y + kNeighbours, side_ - 1); ++v) {
      for (int aside = -kNeighbours; aside <= kNeighbours; ++aside) {
        const float* const row = ground.data() + static_cast<std::ptrdiff_t>(v) * side_ + aside;
        const int end = std::min(side_, side_ - aside);
        for (int x = std::max(0, -aside); x < end; ++x) {
          const auto place = static_cast<std::size_t>(x);
          around[place] += row[x] < kNoGround ? 1 : 0;
          not_above[place] += row[x] <= highest[place] ? 1 : 0;
        }
      }
    }
    for (std::size_t x = 0; x < side; ++x) {
      // The lower quartile of the columns around is at most value + drop.
      if (values[x] < kNoGround && around[x] >= kLeastNeighbours && not_above[x] > around[x] / 4) {
        kept[static_cast<std::size_t>(y) * side + x] = values[x];
      }
    }
  }
  return kept;
}

Terrain::Window Terrain::no_steeper_than_slope(const Window& ground) const {
  // Columns without points of their own take the ground from beside them.
  Window lowest(std::size_t{kTile} * kTile, kNoGround);
  for (int dy = -reach_; dy <= reach_; ++dy) {
    for (int dx = -reach_; dx <= reach_; ++dx) {
      const double distance = std::hypot(dx, dy) * parameters_.terrain_cell;
      if (distance > parameters_.terrain_reach + kRounding) continue;
      const auto rise = static_cast<float>(parameters_.terrain_slope * distance);
      for (int y = 0; y < kTile; ++y) {
        const float* const from = ground.data() + (y + margin_ + dy) * side_ + margin_ + dx;
        float* const to = lowest.data() + y * kTile;
        for (int x = 0; x < kTile; ++x) to[x] = std::min(to[x], from[x] + rise);
      }
    }
  }
  return lowest;
}

void Terrain::update(const RunContext& context) {
  const StageScope timed(context.times, "terrain");
  std::vector<VoxelKey> tiles(changed_.begin(), changed_.end());
  changed_.clear();
  std::fill(has_news_.begin(), has_news_.end(), std::uint8_t{0});
  std::sort(tiles.begin(), tiles.end());
  std::vector<Window> found(tiles.size());
  parallel_for(context.threads, tiles.size(), 1, [&](std::size_t i) {
    Window ground = low_quantiles(voxel_index(tiles[i]));
    for (int round = 0; round < kPitRounds; ++round) ground = without_pits(ground);
    found[i] = no_steeper_than_slope(ground);
  });
  Heights::Cursor cursor;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const VoxelIndex corner = voxel_index(tiles[i]) * kTile;
    float* const cells = &ground_.make(corner, cursor);
    std::transform(found[i].begin(), found[i].end(), cells,
                   [](float ground) { return ground < kNoGround ? ground : -kNoGround; });
  }
}

void Terrain::find_heights(const ScanCells& cells, const RunContext& context,
                           std::vector<float>& heights) const {
  heights.resize(cells.size());
  parallel_chunks(
      context.threads, cells.size(), kPointsATask, [&](std::size_t begin, std::size_t end) {
        Heights::Cursor cursor;
        for (std::size_t k = begin; k < end; ++k) {
          heights[k] = cells.height[k] - ground_.get({cells.x[k], cells.y[k], 0}, cursor);
        }
      });
}

}  // namespace raymoval::raymoval_plus_method
