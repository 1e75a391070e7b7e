// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/terrain.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace raymoval {
namespace {

constexpr double kStep = 0.05;  // Metres of z that a counter stands for.
constexpr std::uint64_t kMinimumPoints = 3;
constexpr int kNeighbours = 4;  // Columns to either side: 9 x 9.
constexpr int kMinimumNeighbours = 4;
constexpr int kTile = Terrain::Heights::kSideXY;
constexpr float kNoGround = std::numeric_limits<float>::infinity();

}  // namespace

Terrain::Terrain(const RaymovalPlusParameters& parameters)
    : parameters_(parameters),
      inverse_cell_(1.0 / parameters.terrain_cell),
      reach_(static_cast<int>(std::floor(parameters.terrain_reach * inverse_cell_ + 1e-9))),
      margin_(2 * kNeighbours + reach_),
      side_(kTile + 2 * margin_),
      counts_(0),
      ground_(-kNoGround) {}

void Terrain::add(const std::vector<Eigen::Vector3d>& points) {
  Counts::Cursor cursor;
  const Eigen::Array3d scale(inverse_cell_, inverse_cell_, 1.0 / kStep);
  std::uint32_t last = Counts::kNone;
  for (const Eigen::Vector3d& point : points) {
    const VoxelIndex cell = voxel_index(point.array() * scale, 1.0);
    ++counts_.make(cell, cursor);
    if (cursor.block != last) note_change(counts_.block_index(cursor.block));
    last = cursor.block;
  }
}

void Terrain::note_change(const VoxelIndex& block) {
  const auto [extent, fresh] =
      extents_.emplace(voxel_key(block.x(), block.y(), 0), std::pair{block.z(), block.z()});
  extent.value().first = std::min(extent->second.first, block.z());
  extent.value().second = std::max(extent->second.second, block.z());
  const auto tile = [](int column) { return static_cast<int>(std::floor(column * (1.0 / kTile))); };
  const int x = block.x() * Counts::kSideXY, y = block.y() * Counts::kSideXY;
  for (int ty = tile(y - margin_); ty <= tile(y + Counts::kSideXY - 1 + margin_); ++ty) {
    for (int tx = tile(x - margin_); tx <= tile(x + Counts::kSideXY - 1 + margin_); ++tx) {
      changed_.insert(voxel_key(tx, ty, 0));
    }
  }
}

Terrain::Window Terrain::low_quantiles(const VoxelIndex& tile) const {
  Window window(static_cast<std::size_t>(side_ * side_), kNoGround);
  const int left = tile.x() * kTile - margin_, bottom = tile.y() * kTile - margin_;
  const int shift = Counts::kSideXY;
  const auto block = [&](int column) {
    return static_cast<int>(std::floor(column * (1.0 / shift)));
  };
  for (int y = block(bottom); y <= block(bottom + side_ - 1); ++y) {
    for (int x = block(left); x <= block(left + side_ - 1); ++x) {
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
  std::vector<std::pair<int, const std::uint32_t*>> stack;  // From below.
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
    if (points < kMinimumPoints) continue;
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
  const auto drop = static_cast<float>(parameters_.terrain_drop);
  for (int y = 0; y < side_; ++y) {
    for (int x = 0; x < side_; ++x) {
      const float value = ground[static_cast<std::size_t>(y * side_ + x)];
      if (value == kNoGround) continue;
      int around = 0, not_above = 0;
      for (int v = std::max(y - kNeighbours, 0); v <= std::min(y + kNeighbours, side_ - 1); ++v) {
        const float* const row = ground.data() + static_cast<std::size_t>(v * side_);
        for (int u = std::max(x - kNeighbours, 0); u <= std::min(x + kNeighbours, side_ - 1); ++u) {
          around += row[u] < kNoGround ? 1 : 0;
          not_above += row[u] <= value + drop ? 1 : 0;
        }
      }
      // The quartile is at most value + drop.
      if (around >= kMinimumNeighbours && not_above > around / 4) {
        kept[static_cast<std::size_t>(y * side_ + x)] = value;
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
      if (distance > parameters_.terrain_reach + 1e-9) continue;
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

void Terrain::update(int threads) {
  std::vector<VoxelKey> tiles(changed_.begin(), changed_.end());
  changed_.clear();
  std::sort(tiles.begin(), tiles.end());
  std::vector<Window> found(tiles.size());
  parallel_for(threads, tiles.size(), 1, [&](std::size_t i) {
    Window ground = low_quantiles(voxel_index(tiles[i]));
    for (int round = 0; round < 2; ++round) ground = without_pits(ground);
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

}  // namespace raymoval
