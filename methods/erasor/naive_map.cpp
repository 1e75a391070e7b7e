// SPDX-License-Identifier: MIT
#include "methods/erasor/naive_map.h"

#include <algorithm>
#include <utility>

#include "core/error.h"

namespace raymoval::erasor_method {
namespace {

constexpr double kTileSize = 5.0;

VoxelIndex tile_index(const Eigen::Vector3d& point) {
  return voxel_index(Eigen::Vector3d(point.x(), point.y(), 0.0), 1.0 / kTileSize);
}

}  // namespace

NaiveMap::NaiveMap(Chunks<VoxelKey> keys, Chunks<Eigen::Vector3d> points)
    : keys_(std::move(keys)), points_(std::move(points)), in_(keys_.size(), 1) {
  Chunks<VoxelNumber> numbers;
  // Voxels are numbered tile by tile, in the given order within a tile.
  VoxelMap<std::uint32_t> tile_numbers;
  std::vector<VoxelKey> tile_keys;
  std::vector<VoxelNumber> ends;
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    const VoxelKey tile = voxel_key(tile_index(points_[i]));
    const auto found = tile_numbers.try_emplace(tile, static_cast<std::uint32_t>(ends.size()));
    if (found.second) {
      tile_keys.push_back(tile);
      ends.push_back(0);
    }
    numbers.push_back(found.first->second);  // For now the number of the tile.
    ++ends[numbers[i]];
  }
  VoxelNumber sum = 0;
  for (std::size_t t = 0; t < ends.size(); ++t) {
    tiles_[tile_keys[t]] = {sum, sum + ends[t]};
    sum += ends[t];
    ends[t] = sum - ends[t];  // Now the place of the tile's next voxel.
  }
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = ends[numbers[i]]++;
  renumber(numbers);
}

/// Gives every voxel its number, in place. @param numbers of the voxels; afterwards 0, 1, 2, ...
void NaiveMap::renumber(Chunks<VoxelNumber>& numbers) {
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

void NaiveMap::put_back(VoxelKey key, const Eigen::Vector3d& point) {
  if (!out_.contains(key)) return;
  in_[number_of(key, point)] = 1;
  out_.erase(key);
}

/// The number of a voxel of the map. It is in the tile of `point`, or in a neighbour tile, because
/// a voxel may cross a tile's edge.
VoxelNumber NaiveMap::number_of(VoxelKey key, const Eigen::Vector3d& point) const {
  const VoxelIndex own = tile_index(point);
  for (const int dy : {0, -1, 1}) {
    for (const int dx : {0, -1, 1}) {
      const auto tile = tiles_.find(voxel_key(own.x() + dx, own.y() + dy, 0));
      if (tile == tiles_.end()) continue;
      for (VoxelNumber voxel = tile->second.begin; voxel < tile->second.end; ++voxel) {
        if (keys_[voxel] == key) return voxel;
      }
    }
  }
  throw InternalError("ERASOR's map does not find a voxel in its tile");
}

void NaiveMapBuilder::add(const std::vector<VoxelKey>& keys,
                          const std::vector<Eigen::Vector3d>& points) {
  const auto key_in_scan = [this](VoxelNumber place) { return in_scan_[place].key; };
  in_scan_.clear();
  places_.clear();
  VoxelKey last_key = kNoVoxel;  // Neighbours of a beam often share their voxel.
  VoxelNumber place = 0;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i] == kNoVoxel) continue;
    if (keys[i] != last_key) {
      last_key = keys[i];
      place = places_.add(last_key, key_in_scan);
      if (place == in_scan_.size()) in_scan_.push_back({last_key, Eigen::Vector3d::Zero(), 0});
    }
    in_scan_[place].sum += points[i];
    ++in_scan_[place].points;
  }
  for (const VoxelOfScan& collected : in_scan_) {
    const VoxelNumber number =
        numbers_.add(collected.key, [this](VoxelNumber one) { return keys_[one]; });
    if (number == keys_.size()) {
      keys_.push_back(collected.key);
      sums_of_means_.push_back(Eigen::Vector3d::Zero());
      scans_.push_back(0);
    }
    sums_of_means_[number] += collected.sum / collected.points;
    ++scans_[number];
  }
}

NaiveMap NaiveMapBuilder::finish() {
  numbers_ = {};
  in_scan_ = {};
  places_ = {};
  for (VoxelNumber number = 0; number < scans_.size(); ++number) {
    sums_of_means_[number] /= scans_[number];
  }
  scans_ = {};
  return {std::move(keys_), std::move(sums_of_means_)};
}

}  // namespace raymoval::erasor_method
