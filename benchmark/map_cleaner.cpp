// SPDX-License-Identifier: MIT
#include "benchmark/map_cleaner.h"

#include <algorithm>

namespace raymoval {

void MapCollector::add(const Scan& scan, const Mask& mask, std::uint8_t wanted) {
  if (scan.size() > 0 && scan.reflectance.empty()) has_reflectance_ = false;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (mask[i] != wanted) continue;
    const Eigen::Vector3d world = scan.T_world_sensor * scan.points[i].cast<double>();
    const float reflectance = scan.reflectance.empty() ? 0.0F : scan.reflectance[i];
    if (voxel_size_ <= 0.0) {
      points_.push_back(world.cast<float>());
      reflectance_.push_back(reflectance);
      continue;
    }
    Cell& cell = cells_[voxel_key(voxel_index(world, 1.0 / voxel_size_))];
    cell.sum += world;
    cell.reflectance += static_cast<double>(reflectance);
    ++cell.count;
  }
}

std::vector<VoxelKey> MapCollector::sorted_keys() const {
  std::vector<VoxelKey> keys;
  keys.reserve(cells_.size());
  for (const auto& [key, cell] : cells_) keys.push_back(key);
  std::sort(keys.begin(), keys.end());
  return keys;
}

std::vector<Eigen::Vector3f> MapCollector::points() const {
  if (voxel_size_ <= 0.0) return points_;
  std::vector<Eigen::Vector3f> points;
  for (const VoxelKey key : sorted_keys()) {
    const Cell& cell = cells_.at(key);
    const Eigen::Vector3d mean = cell.sum / static_cast<double>(cell.count);
    points.push_back(mean.cast<float>());
  }
  return points;
}

std::vector<float> MapCollector::reflectance() const {
  if (!has_reflectance_) return {};
  if (voxel_size_ <= 0.0) return reflectance_;
  std::vector<float> reflectance;
  for (const VoxelKey key : sorted_keys()) {
    const Cell& cell = cells_.at(key);
    reflectance.push_back(static_cast<float>(cell.reflectance / static_cast<double>(cell.count)));
  }
  return reflectance;
}

}  // namespace raymoval
