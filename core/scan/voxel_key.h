// SPDX-License-Identifier: MIT
#pragma once

#include <tsl/robin_map.h>
#include <tsl/robin_set.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

namespace raymoval {

/// Cell indices on the lattice anchored at the world origin.
using VoxelIndex = Eigen::Vector3i;

/// 64-bit name of a cell: 21 bits an axis, z above y above x, so that sorted keys run along x
/// fastest, then y, then z.
using VoxelKey = std::uint64_t;

inline constexpr int kVoxelBits = 21;
inline constexpr int kVoxelBias = 1 << (kVoxelBits - 1);
/// Largest magnitude of a cell index: 209 km either way with cells of 0.2 m.
inline constexpr int kVoxelLimit = kVoxelBias - 1;

/// Throws DataError: the point lies beyond the lattice, or is not finite.
[[noreturn]] void throw_voxel_out_of_range(double x, double y, double z, double voxel_size);

/// Cell of a world point: floor(coordinate / voxel_size) for either sign; a point on a wall belongs
/// to the upper cell. @throws DataError beyond `kVoxelLimit` cells, never wraps around.
inline VoxelIndex voxel_index(const Eigen::Vector3d& point, double inverse_voxel_size) {
  const double x = std::floor(point.x() * inverse_voxel_size);
  const double y = std::floor(point.y() * inverse_voxel_size);
  const double z = std::floor(point.z() * inverse_voxel_size);
  if (!(std::abs(x) <= kVoxelLimit && std::abs(y) <= kVoxelLimit && std::abs(z) <= kVoxelLimit)) {
    throw_voxel_out_of_range(point.x(), point.y(), point.z(), 1.0 / inverse_voxel_size);
  }
  return {static_cast<int>(x), static_cast<int>(y), static_cast<int>(z)};
}

constexpr VoxelKey voxel_key(int x, int y, int z) {
  return (static_cast<VoxelKey>(z + kVoxelBias) << (2 * kVoxelBits)) |
         (static_cast<VoxelKey>(y + kVoxelBias) << kVoxelBits) |
         static_cast<VoxelKey>(x + kVoxelBias);
}

inline VoxelKey voxel_key(const VoxelIndex& index) {
  return voxel_key(index.x(), index.y(), index.z());
}

inline VoxelIndex voxel_index(VoxelKey key) {
  constexpr VoxelKey kMask = (VoxelKey{1} << kVoxelBits) - 1;
  return {static_cast<int>(key & kMask) - kVoxelBias,
          static_cast<int>((key >> kVoxelBits) & kMask) - kVoxelBias,
          static_cast<int>((key >> (2 * kVoxelBits)) & kMask) - kVoxelBias};
}

/// Spreads the three packed indices over all 64 bits.
struct VoxelKeyHash {
  std::size_t operator()(VoxelKey key) const noexcept {
    key ^= key >> 32;
    key *= 0x9E3779B97F4A7C15ULL;
    key ^= key >> 29;
    key *= 0xBF58476D1CE4E5B9ULL;
    return key ^ (key >> 32);
  }
};

/// Hash grids. Iteration order is that of the hash: sort the keys before anything depends on it.
template <class Value>
using VoxelMap = tsl::robin_map<VoxelKey, Value, VoxelKeyHash>;
using VoxelSet = tsl::robin_set<VoxelKey, VoxelKeyHash>;

}  // namespace raymoval
