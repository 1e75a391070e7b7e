// SPDX-License-Identifier: MIT
#include "methods/erasor/naive_map.h"

#include <algorithm>

namespace raymoval::erasor_method {
namespace {

constexpr double kTileSize = 5.0;

VoxelIndex tile_index(const Eigen::Vector3d& point) {
  return voxel_index(Eigen::Vector3d(point.x(), point.y(), 0.0), 1.0 / kTileSize);
}

}  // namespace

NaiveMap::NaiveMap(const std::vector<VoxelKey>& keys, const std::vector<Eigen::Vector3d>& points)
    : keys_(keys.size()), points_(points.size()), in_(keys.size(), 1) {
  // Voxels are numbered tile by tile, in each tile as they are given.
  VoxelMap<std::uint32_t> tile_numbers;
  std::vector<std::uint32_t> tile_of(keys.size());
  std::vector<VoxelKey> tile_keys;
  std::vector<VoxelNumber> ends;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const VoxelKey tile = voxel_key(tile_index(points[i]));
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
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const VoxelNumber number = ends[tile_of[i]]++;
    keys_[number] = keys[i];
    points_[number] = points[i];
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

std::uint32_t NaiveMapBuilder::slot_of(VoxelKey key) {
  const auto found = numbers_.try_emplace(key, static_cast<VoxelNumber>(voxels_.size()));
  const VoxelNumber number = found.first->second;
  if (found.second) voxels_.push_back({key, Eigen::Vector3d::Zero(), 0, 0});
  Voxel& voxel = voxels_[number];
  const bool known = voxel.slot < in_scan_.size() && in_scan_[voxel.slot].voxel == number;
  if (!known) {
    voxel.slot = static_cast<std::uint32_t>(in_scan_.size());
    in_scan_.push_back({number, 0, Eigen::Vector3d::Zero()});
  }
  return voxel.slot;
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
    voxels_[collected.voxel].sum_of_means += collected.sum / collected.points;
    ++voxels_[collected.voxel].scans;
  }
}

NaiveMap NaiveMapBuilder::finish() const {
  std::vector<VoxelKey> keys(voxels_.size());
  std::vector<Eigen::Vector3d> points(voxels_.size());
  for (std::size_t i = 0; i < voxels_.size(); ++i) {
    keys[i] = voxels_[i].key;
    points[i] = voxels_[i].sum_of_means / voxels_[i].scans;
  }
  return {keys, points};
}

}  // namespace raymoval::erasor_method
