// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/voxel_key.h"

namespace raymoval {

enum class Evidence : std::uint8_t { kUndecided = 0, kStatic = 1, kDynamic = 2 };

/// The occupied voxels of all scans, each with its centroid and what the scans say of it.
///
/// Filled point by point, then frozen: from then on voxels have numbers, and those of one
/// 12.8 m x 12.8 m tile (64 voxels) of the ground are neighbours in memory.
class EvidenceMap {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  explicit EvidenceMap(double voxel_size) : size_(voxel_size), inverse_(1.0 / voxel_size) {}

  [[nodiscard]] VoxelIndex index_of(const Eigen::Vector3d& point) const {
    return voxel_index(point, inverse_);
  }
  /// Adds a world point, metres. The order of the calls does not matter.
  void add(const Eigen::Vector3d& point);
  /// Ends the filling.
  void freeze();

  [[nodiscard]] std::size_t size() const { return keys_.size(); }
  /// Number of the voxel that holds a point, or `kNone`.
  [[nodiscard]] std::uint32_t find(VoxelKey key) const {
    const auto found = numbers_.find(key);
    return found == numbers_.end() ? kNone : found->second;
  }
  [[nodiscard]] VoxelKey key(std::size_t voxel) const { return keys_[voxel]; }
  /// Mean of the voxel's points, world frame, metres.
  [[nodiscard]] Eigen::Vector3d centroid(std::size_t voxel) const;

  /// Calls `visit(first, last)` for the voxels of each tile that has a part within `range` metres
  /// of `center`, seen from above; tiles in a fixed order.
  template <class Visit>
  void for_tiles_near(const Eigen::Vector3d& center, double range, Visit&& visit) const {
    const double side = kTile * size_;
    const int reach = static_cast<int>(std::ceil(range / side));
    const int cx = static_cast<int>(std::floor(center.x() / side));
    const int cy = static_cast<int>(std::floor(center.y() / side));
    for (int y = cy - reach; y <= cy + reach; ++y) {
      for (int x = cx - reach; x <= cx + reach; ++x) {
        const auto found = tiles_.find(voxel_key(x, y, 0));
        if (found != tiles_.end()) visit(found->second.first, found->second.second);
      }
    }
  }

  /// Calls `visit(first, last)` for the voxels of each brick of 8 x 8 x 8 in order.
  [[nodiscard]] std::size_t brick_count() const { return bricks_.size(); }
  struct Brick {
    VoxelIndex index;  ///< In bricks.
    std::uint32_t first, last;
  };
  [[nodiscard]] const Brick& brick(std::size_t number) const { return bricks_[number]; }
  [[nodiscard]] const Brick* brick_at(const VoxelIndex& index) const {
    const auto found = brick_numbers_.find(voxel_key(index));
    return found == brick_numbers_.end() ? nullptr : &bricks_[found->second];
  }

  std::vector<std::uint16_t> free_scans;   ///< Scans that saw through the voxel.
  std::vector<std::uint16_t> agree_scans;  ///< Scans with a return at the voxel.
  std::vector<std::uint16_t> leading_free, trailing_free;
  std::vector<Evidence> evidence;

 private:
  static constexpr int kTile = 64;
  /// Sums of the offsets from the voxel's lower corner in 1/256 of its edge.
  struct Moments {
    std::uint32_t x = 0, y = 0, z = 0, count = 0;
  };

  void index_tiles_and_bricks();

  double size_, inverse_;
  VoxelMap<std::uint32_t> numbers_;
  std::vector<VoxelKey> keys_;
  std::vector<Moments> moments_;
  VoxelMap<std::pair<std::uint32_t, std::uint32_t>> tiles_;
  std::vector<Brick> bricks_;
  VoxelMap<std::uint32_t> brick_numbers_;
};

}  // namespace raymoval
