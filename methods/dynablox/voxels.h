// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/scan/scan.h"
#include "methods/common/sparse_blocks.h"
#include "methods/dynablox/dynablox.h"

namespace raymoval::dynablox_method {

// Voxels are stored in blocks of 16 x 16 x 16, which consist of horizontal layers.
inline constexpr int kSideBits = 4;
inline constexpr int kSide = 1 << kSideBits;
inline constexpr int kLayer = kSide * kSide;

/// Block of a voxel: its indices divided by the block's side, rounded down.
inline VoxelIndex block_of(const VoxelIndex& voxel) {
  return {voxel.x() >> kSideBits, voxel.y() >> kSideBits, voxel.z() >> kSideBits};
}
/// Row of a voxel in its block, along x: z above y.
inline std::size_t row_of(const VoxelIndex& voxel) {
  return static_cast<std::size_t>((voxel.z() & (kSide - 1)) * kSide + (voxel.y() & (kSide - 1)));
}
/// Bit of a voxel in its row.
inline std::uint16_t bit_of(const VoxelIndex& voxel) {
  return static_cast<std::uint16_t>(1U << (voxel.x() & (kSide - 1)));
}

/// A bit for each voxel of a block, a word for each row along x.
using BlockBits = std::array<std::uint16_t, kLayer>;

inline bool contains(const BlockBits& bits, const VoxelIndex& voxel) {
  return (bits[row_of(voxel)] & bit_of(voxel)) != 0;
}
inline void insert(const VoxelIndex& voxel, BlockBits& bits) {
  bits[row_of(voxel)] = static_cast<std::uint16_t>(bits[row_of(voxel)] | bit_of(voxel));
}

/// The state of 256 voxels at one height, x fastest: 14 bytes per voxel.
struct alignas(64) Layer {
  std::array<float, kLayer> distance{};              ///< Mean signed distance to a surface, metres.
  std::array<float, kLayer> weight{};                ///< Of that mean; 0 = never seen.
  std::array<std::int32_t, kLayer> last_occupied{};  ///< Position in the source.
  std::array<std::uint16_t, kLayer>
      occupied_scans{};  ///< Number of occupied scans without a long break.
};

struct Block {
  explicit Block(const VoxelIndex& position) : at(position) {}

  VoxelIndex at;  ///< Block indices (see `block_of`).
  /// Null until a voxel of the layer was seen. Until then, all its voxels have the next two values:
  std::array<std::unique_ptr<Layer>, kSide> layers;
  std::uint16_t unseen_occupied_scans = 0;
  std::int32_t unseen_last_occupied = -1;
  BlockBits ever_free{};
  /// Voxels that were seen and not occupied within the burn-in, as of scan `settled_at`.
  BlockBits settled{};
  std::int32_t settled_at = -1;
};
using BlockMap = SparseBlocks<Block>;

/// The voxels of a scan's points.
struct ScanVoxels {
  std::vector<VoxelIndex> voxels;  ///< Of each point.
  SparseBlocks<BlockBits> hits;    ///< The same as a set.
};

/// Steps 1 and 2.
void find_voxels(const Scan& scan, double voxel_size, ScanVoxels& found);

/// Points of a scan that move together, ascending.
using Cluster = std::vector<std::uint32_t>;

/// Steps 3 to 5: the clusters of a scan.
std::vector<Cluster> find_clusters(const ScanVoxels& scan, const BlockMap& map,
                                   const Parameters& parameters);

}  // namespace raymoval::dynablox_method
