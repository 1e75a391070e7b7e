// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence_map.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace raymoval {
namespace {

constexpr int kBrickShift = 3;  // 8 voxels.
constexpr int kTileShift = 6;   // 64 voxels.
constexpr double kFraction = 256.0;
/// Stops a voxel's sums from running over; its centroid has long settled by then.
constexpr std::uint32_t kMostPoints = 1U << 24;

VoxelKey tile_key(const VoxelIndex& voxel) {
  return voxel_key(voxel.x() >> kTileShift, voxel.y() >> kTileShift, 0);
}

VoxelIndex brick_index(const VoxelIndex& voxel) {
  return {voxel.x() >> kBrickShift, voxel.y() >> kBrickShift, voxel.z() >> kBrickShift};
}

}  // namespace

void EvidenceMap::add(const Eigen::Vector3d& point) {
  const VoxelIndex voxel = index_of(point);
  const auto [found, fresh] =
      numbers_.emplace(voxel_key(voxel), static_cast<std::uint32_t>(keys_.size()));
  if (fresh) {
    keys_.push_back(found->first);
    moments_.emplace_back();
  }
  Moments& moments = moments_[found->second];
  if (moments.count >= kMostPoints) return;
  const auto part = [&](int axis) {
    const double offset = point[axis] * inverse_ - voxel[axis];
    return static_cast<std::uint32_t>(std::clamp(offset * kFraction, 0.0, kFraction - 1.0));
  };
  moments.x += part(0);
  moments.y += part(1);
  moments.z += part(2);
  ++moments.count;
}

void EvidenceMap::freeze() {
  std::vector<std::uint32_t> order(keys_.size());
  std::iota(order.begin(), order.end(), 0U);
  std::vector<std::pair<VoxelKey, VoxelKey>> place(keys_.size());
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    const VoxelIndex voxel = voxel_index(keys_[i]);
    place[i] = {tile_key(voxel), voxel_key(brick_index(voxel))};
  }
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tie(place[a], keys_[a]) < std::tie(place[b], keys_[b]);
  });
  std::vector<VoxelKey> keys(keys_.size());
  std::vector<Moments> moments(keys_.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    keys[i] = keys_[order[i]];
    moments[i] = moments_[order[i]];
  }
  keys_ = std::move(keys);
  moments_ = std::move(moments);
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    numbers_.find(keys_[i]).value() = static_cast<std::uint32_t>(i);
  }
  free_scans.assign(keys_.size(), 0);
  agree_scans.assign(keys_.size(), 0);
  leading_free.assign(keys_.size(), 0);
  trailing_free.assign(keys_.size(), 0);
  evidence.assign(keys_.size(), Evidence::kUndecided);
  index_tiles_and_bricks();
}

void EvidenceMap::index_tiles_and_bricks() {
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    const auto number = static_cast<std::uint32_t>(i);
    const VoxelIndex voxel = voxel_index(keys_[i]);
    const auto tile = tiles_.emplace(tile_key(voxel), std::pair{number, number});
    tile.first.value().second = number + 1;
    const VoxelIndex brick = brick_index(voxel);
    if (bricks_.empty() || bricks_.back().index != brick) {
      brick_numbers_[voxel_key(brick)] = static_cast<std::uint32_t>(bricks_.size());
      bricks_.push_back({brick, number, number});
    }
    bricks_.back().last = number + 1;
  }
}

Eigen::Vector3d EvidenceMap::centroid(std::size_t voxel) const {
  const Moments& moments = moments_[voxel];
  const double scale = 1.0 / (kFraction * moments.count), half = 0.5 / kFraction;
  const Eigen::Vector3d offset(moments.x * scale + half, moments.y * scale + half,
                               moments.z * scale + half);
  return (voxel_index(keys_[voxel]).cast<double>() + offset) * size_;
}

}  // namespace raymoval
