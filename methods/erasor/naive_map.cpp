// SPDX-License-Identifier: MIT
#include "methods/erasor/naive_map.h"

#include <algorithm>
#include <utility>

namespace raymoval::erasor_method {
namespace {

constexpr double kTileSize = 5.0;

VoxelIndex tile_index(const Eigen::Vector3d& point) {
  return voxel_index(Eigen::Vector3d(point.x(), point.y(), 0.0), 1.0 / kTileSize);
}

}  // namespace

NaiveMap::NaiveMap(std::vector<VoxelKey> keys, std::vector<Eigen::Vector3d> points)
    : keys_(std::move(keys)), points_(std::move(points)), in_(keys_.size(), 1) {
  // Voxels are numbered tile by tile, in each tile as they are given.
  VoxelMap<std::uint32_t> tile_numbers;
  std::vector<std::uint32_t> tile_of(keys_.size());
  std::vector<VoxelKey> tile_keys;
  std::vector<VoxelNumber> ends;
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    const VoxelKey tile = voxel_key(tile_index(points_[i]));
    const auto found = tile_numbers.try_emplace(tile, static_cast<std::uint32_t>(ends.size()));
    if (found.second) {
      tile_keys.push_back(tile);
      ends.push_back(0);
    }
    tile_of[i] = found.first->second;
    ++ends[tile_of[i]];
  }
  VoxelNumber sum = 0;
  for (std::size_t t = 0; t < ends.size(); ++t) {
    tiles_[tile_keys[t]] = {sum, sum + ends[t]};
    sum += ends[t];
    ends[t] = sum - ends[t];  // Now the place of the tile's next voxel.
  }
  std::vector<VoxelNumber>& numbers = tile_of;  // In the same memory.
  for (VoxelNumber& number : numbers) number = ends[number]++;
  renumber(numbers);
}

/// Gives every voxel its number, in place. @param numbers of the voxels; afterwards 0, 1, 2, ...
void NaiveMap::renumber(std::vector<VoxelNumber>& numbers) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    while (numbers[i] != i) {
      const VoxelNumber to = numbers[i];
      std::swap(keys_[i], keys_[to]);
      std::swap(points_[i], points_[to]);
      std::swap(numbers[i], numbers[to]);
    }
  }
}

std::vector<NaiveMap::Tile> NaiveMap::tiles_around(double x, double y, double radius) const {
  const VoxelIndex low = tile_index({x - radius, y - radius, 0.0});
  const VoxelIndex high = tile_index({x + radius, y + radius, 0.0});
  std::vector<Tile> tiles;
  for (int ty = low.y(); ty <= high.y(); ++ty) {
    for (int tx = low.x(); tx <= high.x(); ++tx) {
      const auto found = tiles_.find(voxel_key(tx, ty, 0));
      if (found == tiles_.end()) continue;
      const double dx = x - std::clamp(x, tx * kTileSize, (tx + 1) * kTileSize);
      const double dy = y - std::clamp(y, ty * kTileSize, (ty + 1) * kTileSize);
      if (dx * dx + dy * dy <= radius * radius) tiles.push_back(found->second);
    }
  }
  return tiles;
}

void NaiveMap::put_back(VoxelKey key) {
  const auto found = out_.find(key);
  if (found == out_.end()) return;
  in_[found->second] = 1;
  out_.erase(found);
}

VoxelNumber NaiveMapBuilder::number_of(VoxelKey key) {
  if (4 * std::size_t{size_} >= 3 * table_.size()) grow_table();
  const std::size_t mask = table_.size() - 1;
  std::size_t at = VoxelKeyHash{}(key)&mask;
  for (; table_[at] != kFree; at = (at + 1) & mask) {
    if (voxel(table_[at]).key == key) return table_[at];
  }
  if (size_ % kChunk == 0) chunks_.push_back(std::make_unique<Voxel[]>(kChunk));
  table_[at] = size_;
  voxel(size_) = {key, Eigen::Vector3d::Zero(), 0, 0};
  return size_++;
}

void NaiveMapBuilder::grow_table() {
  table_.assign(std::max<std::size_t>(2 * table_.size(), 1024), kFree);
  const std::size_t mask = table_.size() - 1;
  for (VoxelNumber number = 0; number < size_; ++number) {
    std::size_t at = VoxelKeyHash{}(voxel(number).key) & mask;
    while (table_[at] != kFree) at = (at + 1) & mask;
    table_[at] = number;
  }
}

std::uint32_t NaiveMapBuilder::slot_of(VoxelKey key) {
  const VoxelNumber number = number_of(key);
  Voxel& found = voxel(number);
  const bool known = found.slot < in_scan_.size() && in_scan_[found.slot].voxel == number;
  if (!known) {
    found.slot = static_cast<std::uint32_t>(in_scan_.size());
    in_scan_.push_back({number, 0, Eigen::Vector3d::Zero()});
  }
  return found.slot;
}

void NaiveMapBuilder::add(const std::vector<VoxelKey>& keys,
                          const std::vector<Eigen::Vector3d>& points) {
  in_scan_.clear();
  VoxelKey last_key = kNoVoxel;  // Neighbours of a beam often share their voxel.
  std::uint32_t slot = 0;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i] == kNoVoxel) continue;
    if (keys[i] != last_key) {
      last_key = keys[i];
      slot = slot_of(last_key);
    }
    in_scan_[slot].sum += points[i];
    ++in_scan_[slot].points;
  }
  for (const VoxelOfScan& collected : in_scan_) {
    Voxel& filled = voxel(collected.voxel);
    filled.sum_of_means += collected.sum / collected.points;
    ++filled.scans;
  }
}

NaiveMap NaiveMapBuilder::finish() {
  table_ = {};
  std::vector<VoxelKey> keys;
  std::vector<Eigen::Vector3d> points;
  keys.reserve(size_);
  points.reserve(size_);
  for (VoxelNumber number = 0; number < size_; ++number) {
    const Voxel& collected = voxel(number);
    keys.push_back(collected.key);
    points.emplace_back(collected.sum_of_means / collected.scans);
    // What was read is given back at once, so that the voxels are not in memory twice.
    if ((number + 1) % kChunk == 0) chunks_[number / kChunk].reset();
  }
  chunks_.clear();
  size_ = 0;
  return {std::move(keys), std::move(points)};
}

}  // namespace raymoval::erasor_method
