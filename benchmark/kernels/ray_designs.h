// SPDX-License-Identifier: MIT
// The usual way to find first hits, for comparison: one ray after the other.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "methods/raymoval/kernels/first_hit.h"

namespace raymoval::kernels_bench {

using namespace raymoval_method;

/// All rays of an image, and the destination of their ranges.
struct ImageJob {
  const FirstHitImage* frame = nullptr;  ///< Grid, pose, limits and directions.
  std::vector<float>* range = nullptr;
};

/// The map's bounding box as a block of bits.
class DenseBits {
 public:
  /// @throws DataError if the block would be larger than 256 MiB
  explicit DenseBits(const OccupancyMap& map);
  [[nodiscard]] bool contains(std::int64_t bit) const {
    return (words_[static_cast<std::size_t>(bit >> 5)] >> (bit & 31) & 1U) != 0;
  }
  [[nodiscard]] const Eigen::Vector3i& low() const { return low_; }
  [[nodiscard]] const Eigen::Vector3i& size() const { return size_; }
  [[nodiscard]] double voxel_size() const { return voxel_size_; }
  [[nodiscard]] std::array<std::int64_t, 3> strides() const {
    return {static_cast<std::int64_t>(size_.z()) * size_.y(), size_.z(), 1};
  }

 private:
  Eigen::Vector3i low_, size_;
  double voxel_size_;
  std::vector<std::uint32_t> words_;
};

/// Amanatides and Woo in float with accumulated planes. @return the number of steps made
std::int64_t dense_bitset_dda(const DenseBits& bits, const ImageJob& job);

/// Calls `visit` with the index of each occupied voxel, in the order of the map's bricks.
template <class Visit>
void for_voxels(const OccupancyMap& map, Visit&& visit) {
  for (std::size_t tile = 0; tile < map.tile_count(); ++tile) {
    for (const OccupancyMap::BrickHead& head : map.tile(tile)) {
      const Brick& brick = map.brick(head.slot);
      for (int k = 0; k < 512; ++k) {
        const VoxelIndex voxel(head.at[0] * 8 + (k >> 6), head.at[1] * 8 + (k >> 3 & 7),
                               head.at[2] * 8 + (k & 7));
        if (brick.contains(voxel.x(), voxel.y(), voxel.z())) visit(voxel);
      }
    }
  }
}

}  // namespace raymoval::kernels_bench
