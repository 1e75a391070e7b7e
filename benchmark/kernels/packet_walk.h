// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace raymoval::kernels_bench {

/// State of sixteen rays over a dense block of bits, one array a quantity.
struct Packet {
  alignas(64) float next[3][16];           ///< Range of the next wall along each axis, metres.
  alignas(64) float delta[3][16];          ///< From one wall to the next.
  alignas(64) std::int32_t stride[3][16];  ///< Bits from one voxel to the next.
  alignas(64) std::int32_t left[3][16];    ///< Steps until the ray leaves the block.
  alignas(64) std::int32_t bit[16];        ///< Where the ray is; negative = it is not cast.
  alignas(64) float range[16];             ///< Answer; infinite where nothing is hit.
};

/// Walks the rays in lockstep until each has hit something or left.
void walk_packet(const std::uint32_t* words, float farthest, Packet& packet);

}  // namespace raymoval::kernels_bench
