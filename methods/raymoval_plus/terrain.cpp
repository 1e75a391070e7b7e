// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/terrain.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"

namespace raymoval {
namespace {

constexpr double kStep = 0.05;  // Metres of z that a counter stands for.
constexpr int kMinimumPoints = 3;
constexpr int kNeighbours = 4;  // Columns to either side: 9 x 9.
constexpr std::size_t kMinimumNeighbours = 4;

/// A map's columns in order of their keys, which fixes every order that follows.
std::vector<std::pair<VoxelKey, float>> sorted(const VoxelMap<float>& grid) {
  std::vector<std::pair<VoxelKey, float>> columns(grid.begin(), grid.end());
  std::sort(columns.begin(), columns.end());
  return columns;
}

}  // namespace

Terrain::Terrain(const RaymovalPlusParameters& parameters)
    : parameters_(parameters), inverse_cell_(1.0 / parameters.terrain_cell) {}

void Terrain::add(const Eigen::Vector3d& point) {
  const int x = static_cast<int>(std::floor(point.x() * inverse_cell_));
  const int y = static_cast<int>(std::floor(point.y() * inverse_cell_));
  const int z = static_cast<int>(std::floor(point.z() / kStep));
  // z below y below x, so that sorted keys run up a column.
  ++counts_[voxel_key(z, y, x)];
}

Terrain::Grid Terrain::low_quantiles() {
  std::vector<std::pair<VoxelKey, std::uint32_t>> steps(counts_.begin(), counts_.end());
  counts_ = {};
  std::sort(steps.begin(), steps.end());
  Grid ground;
  for (std::size_t begin = 0; begin < steps.size();) {
    const VoxelKey column = steps[begin].first >> kVoxelBits;
    std::size_t end = begin;
    std::uint64_t points = 0;
    for (; end < steps.size() && steps[end].first >> kVoxelBits == column; ++end) {
      points += steps[end].second;
    }
    if (points >= kMinimumPoints) {
      const double wanted = parameters_.terrain_quantile * static_cast<double>(points);
      std::uint64_t below = 0;
      std::size_t at = begin;
      while (static_cast<double>(below + steps[at].second) < wanted) below += steps[at++].second;
      const VoxelIndex index = voxel_index(steps[at].first);
      const double share = (wanted - static_cast<double>(below)) / steps[at].second;
      ground[voxel_key(index.z(), index.y(), 0)] = static_cast<float>((index.x() + share) * kStep);
    }
    begin = end;
  }
  return ground;
}

Terrain::Grid Terrain::without_pits(const Grid& ground, int threads) const {
  const auto columns = sorted(ground);
  std::vector<std::uint8_t> keep(columns.size(), 0);
  parallel_for(threads, columns.size(), 256, [&](std::size_t i) {
    const VoxelIndex at = voxel_index(columns[i].first);
    std::vector<float> around;
    for (int dy = -kNeighbours; dy <= kNeighbours; ++dy) {
      for (int dx = -kNeighbours; dx <= kNeighbours; ++dx) {
        const auto found = ground.find(voxel_key(at.x() + dx, at.y() + dy, 0));
        if (found != ground.end()) around.push_back(found->second);
      }
    }
    if (around.size() < kMinimumNeighbours) return;
    const auto quartile = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 4);
    std::nth_element(around.begin(), quartile, around.end());
    keep[i] = columns[i].second >= *quartile - parameters_.terrain_drop ? 1 : 0;
  });
  Grid kept;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (keep[i] != 0) kept.insert(columns[i]);
  }
  return kept;
}

Terrain::Grid Terrain::no_steeper_than_slope(const Grid& ground, int threads) const {
  // Columns without points of their own take the ground from beside them.
  const int reach = static_cast<int>(std::floor(parameters_.terrain_reach * inverse_cell_ + 1e-9));
  Grid lowest;
  for (const auto& [key, value] : sorted(ground)) {
    const VoxelIndex at = voxel_index(key);
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        const double distance = std::hypot(dx, dy) * parameters_.terrain_cell;
        if (distance > parameters_.terrain_reach + 1e-9) continue;
        const float bound = value + static_cast<float>(parameters_.terrain_slope * distance);
        const auto [found, fresh] = lowest.emplace(voxel_key(at.x() + dx, at.y() + dy, 0), bound);
        if (!fresh && bound < found->second) found.value() = bound;
      }
    }
  }
  (void)threads;
  return lowest;
}

void Terrain::finish(int threads) {
  Grid ground = low_quantiles();
  for (int round = 0; round < 2; ++round) ground = without_pits(ground, threads);
  ground_ = no_steeper_than_slope(ground, threads);
}

float Terrain::height(const Eigen::Vector3d& point) const {
  const int x = static_cast<int>(std::floor(point.x() * inverse_cell_));
  const int y = static_cast<int>(std::floor(point.y() * inverse_cell_));
  const auto found = ground_.find(voxel_key(x, y, 0));
  if (found == ground_.end()) return std::numeric_limits<float>::infinity();
  return static_cast<float>(point.z()) - found->second;
}

}  // namespace raymoval
