// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/evidence_map.h"

#include <algorithm>
#include <cmath>

namespace raymoval::raymoval_plus_method {
namespace {

/// A point's offset in its voxel is counted in 1/256 of the edge, 0.8 mm at 0.2 m: finer than
/// ranges are measured. Whole numbers give the same sum in any order.
constexpr double kParts = 256.0;
/// With more points a sum of offsets could exceed 32 bits. The mean has long settled by then.
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
    decisions_.resize(blocks_.block_count() * Blocks::kCells, Verdict::kUndecided);
    verdicts_.resize(decisions_.size(), Verdict::kUndecided);
    add_voxel(voxel);
  }
  Voxel& sums = voxels_[number];
  if (!sums.mean_changed) {
    sums.mean_changed = true;
    changed_.push_back(number);
  }
  if (sums.count < kMostPoints) {
    const auto part = [&](int axis) {
      const double offset = point[axis] * inverse_ - voxel[axis];
      return static_cast<std::uint32_t>(std::clamp(offset * kParts, 0.0, kParts - 1.0));
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
    // The height of the tile's first voxel keeps the offsets of all others small.
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

void EvidenceMap::update_means() {
  for (const std::uint32_t number : changed_) {
    Voxel& voxel = voxels_[number];
    voxel.mean_changed = false;
    Tile& tile = tiles_[voxel.tile];
    const Eigen::Vector3f offset = (centroid(number) - tile.origin).cast<float>();
    std::copy_n(offset.data(), 3, tile.places.begin() + 3 * std::ptrdiff_t{voxel.place});
  }
  changed_.clear();
}

Eigen::Vector3d EvidenceMap::centroid(std::size_t voxel) const {
  const Voxel& sums = voxels_[voxel];
  const double scale = 1.0 / (kParts * sums.count), half = 0.5 / kParts;
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

void EvidenceMap::set_decision(std::size_t voxel, Verdict decision) {
  Verdict& now = decisions_[slots_[voxel]];
  if (now == decision) return;
  std::uint8_t& dynamic = dynamic_[block_of(voxel)];
  if (now == Verdict::kDynamic) --dynamic;
  if (decision == Verdict::kDynamic) ++dynamic;
  now = decision;
}

}  // namespace raymoval::raymoval_plus_method
