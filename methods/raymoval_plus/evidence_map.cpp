// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence_map.h"

#include <algorithm>
#include <cmath>

namespace raymoval {
namespace {

constexpr double kFraction = 256.0;
/// Stops a voxel's sums from running over; its centroid has long settled by then.
constexpr std::uint32_t kMostPoints = 1U << 24;

}  // namespace

std::uint32_t EvidenceMap::add(const Eigen::Vector3d& point, Blocks::Cursor& cursor) {
  const VoxelIndex voxel = index_of(point);
  std::uint32_t& number = blocks_.make(voxel, cursor);
  if (number == kNone) {
    number = static_cast<std::uint32_t>(voxels_.size());
    slots_.push_back(
        static_cast<std::uint32_t>(cursor.block * Blocks::kCells + Blocks::offset(voxel)));
    dynamic_.resize(blocks_.block_count(), 0);
    decisions_.resize(blocks_.block_count() * Blocks::kCells, Evidence::kUndecided);
    verdicts_.resize(decisions_.size(), Evidence::kUndecided);
    add_voxel(voxel);
  }
  Voxel& sums = voxels_[number];
  if (!sums.is_unsettled) {
    sums.is_unsettled = true;
    unsettled_.push_back(number);
  }
  if (sums.count < kMostPoints) {
    const auto part = [&](int axis) {
      const double offset = point[axis] * inverse_ - voxel[axis];
      return static_cast<std::uint32_t>(std::clamp(offset * kFraction, 0.0, kFraction - 1.0));
    };
    sums.x += part(0);
    sums.y += part(1);
    sums.z += part(2);
    ++sums.count;
  }
  return number;
}

void EvidenceMap::add_voxel(const VoxelIndex& index) {
  const VoxelIndex at(index.x() >> kTileShift, index.y() >> kTileShift, 0);
  const auto [found, fresh] =
      tile_numbers_.emplace(voxel_key(at), static_cast<std::uint32_t>(tiles_.size()));
  if (fresh) {
    const double side = (1 << kTileShift) * size_;
    // Tiles reach from the deepest to the highest voxel; the first one is in the middle enough.
    tiles_.push_back({{at.x() * side, at.y() * side, index.z() * size_}, {}, {}, {}});
  }
  Tile& tile = tiles_[found->second];
  Voxel& voxel = voxels_.emplace_back();
  voxel.index = index;
  voxel.tile = found->second;
  voxel.place = static_cast<std::uint32_t>(tile.voxels.size());
  tile.voxels.push_back(static_cast<std::uint32_t>(voxels_.size() - 1));
  tile.places.resize(tile.places.size() + 3);
  tile.evidence.emplace_back();
}

void EvidenceMap::settle() {
  for (const std::uint32_t number : unsettled_) {
    Voxel& voxel = voxels_[number];
    voxel.is_unsettled = false;
    Tile& tile = tiles_[voxel.tile];
    const Eigen::Vector3f offset = (centroid(number) - tile.origin).cast<float>();
    std::copy_n(offset.data(), 3, tile.places.begin() + 3 * std::ptrdiff_t{voxel.place});
  }
  unsettled_.clear();
}

Eigen::Vector3d EvidenceMap::centroid(std::size_t voxel) const {
  const Voxel& sums = voxels_[voxel];
  const double scale = 1.0 / (kFraction * sums.count), half = 0.5 / kFraction;
  const Eigen::Vector3d offset(sums.x * scale + half, sums.y * scale + half, sums.z * scale + half);
  return (sums.index.cast<double>() + offset) * size_;
}

std::vector<EvidenceMap::Tile*> EvidenceMap::tiles_near(const Eigen::Vector3d& center,
                                                        double range) {
  const double side = (1 << kTileShift) * size_;
  const int reach = static_cast<int>(std::ceil(range / side));
  const int cx = static_cast<int>(std::floor(center.x() / side));
  const int cy = static_cast<int>(std::floor(center.y() / side));
  std::vector<Tile*> near;
  for (int y = cy - reach; y <= cy + reach; ++y) {
    for (int x = cx - reach; x <= cx + reach; ++x) {
      const auto found = tile_numbers_.find(voxel_key(x, y, 0));
      if (found != tile_numbers_.end()) near.push_back(&tiles_[found->second]);
    }
  }
  return near;
}

void EvidenceMap::set_decision(std::size_t voxel, Evidence decision) {
  Evidence& now = decisions_[slots_[voxel]];
  if (now == decision) return;
  std::uint8_t& dynamic = dynamic_[block_of(voxel)];
  if (now == Evidence::kDynamic) --dynamic;
  if (decision == Evidence::kDynamic) ++dynamic;
  now = decision;
}

}  // namespace raymoval
