// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/voxel_key.h"

namespace raymoval {

/// Occupied voxels in sparse bricks of 8 x 8 x 8, one bit each. Insert, erase and look-up take
/// constant time; memory grows with the occupied part only (at most 76 bytes a brick).
class OccupancyMap {
 public:
  static constexpr int kBrickBits = 3;
  static constexpr int kBrickSide = 1 << kBrickBits;

  /// Voxels of one brick: word = x, byte of the word = y, bit of the byte = z.
  struct Brick {
    std::array<std::uint64_t, kBrickSide> occupied{};
    [[nodiscard]] bool contains(int x, int y, int z) const {
      return (occupied[static_cast<std::size_t>(x & 7)] >> bit(y, z) & 1U) != 0;
    }
    static int bit(int y, int z) { return (y & 7) * kBrickSide + (z & 7); }
  };

  explicit OccupancyMap(double voxel_size)
      : voxel_size_(voxel_size), inverse_voxel_size_(1.0 / voxel_size) {}

  [[nodiscard]] double voxel_size() const { return voxel_size_; }
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Voxel of a world point in metres.
  [[nodiscard]] VoxelIndex voxel_of(const Eigen::Vector3d& world) const {
    return voxel_index(world, inverse_voxel_size_);
  }

  /// True if the voxel was empty.
  bool insert(const VoxelIndex& voxel);
  /// True if the voxel was occupied.
  bool erase(const VoxelIndex& voxel);
  [[nodiscard]] bool contains(const VoxelIndex& voxel) const {
    const Brick* brick = find_brick(brick_of(voxel));
    return brick != nullptr && brick->contains(voxel.x(), voxel.y(), voxel.z());
  }
  /// True if any voxel within `dilation` cells (Chebyshev) is occupied.
  [[nodiscard]] bool contains_near(const VoxelIndex& voxel, int dilation) const;

  [[nodiscard]] static Eigen::Vector3i brick_of(const VoxelIndex& voxel) {
    return {voxel.x() >> kBrickBits, voxel.y() >> kBrickBits, voxel.z() >> kBrickBits};
  }
  /// Bounds of all bricks that ever held a voxel; meaningless in an empty map.
  [[nodiscard]] const Eigen::Vector3i& lowest_brick() const { return lowest_brick_; }
  [[nodiscard]] const Eigen::Vector3i& highest_brick() const { return highest_brick_; }
  /// The brick with these brick coordinates (voxel coordinates / 8, rounded down), or null.
  [[nodiscard]] const Brick* find_brick(const Eigen::Vector3i& brick) const {
    const auto found = index_.find(voxel_key(brick));
    return found == index_.end() ? nullptr : &bricks_[found->second];
  }

 private:
  double voxel_size_;
  double inverse_voxel_size_;
  std::size_t size_ = 0;
  Eigen::Vector3i lowest_brick_ = Eigen::Vector3i::Constant(kVoxelLimit);
  Eigen::Vector3i highest_brick_ = Eigen::Vector3i::Constant(-kVoxelLimit);
  VoxelMap<std::uint32_t> index_;
  std::vector<Brick> bricks_;
};

}  // namespace raymoval
