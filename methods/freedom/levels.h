// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/scan/voxel_key.h"
#include "methods/freedom/parameters.h"

namespace raymoval::freedom_method {

/// How surely something does not stay where it was seen. A point replaces those of a higher level.
enum class Level : std::uint8_t {
  kStatic,
  kAggressive,    ///< Near a moderate one.
  kModerate,      ///< Beside a conservative one.
  kConservative,  ///< In free space.
  kEmpty,         ///< There is no point any more.
};

/// The first `count` neighbours of a voxel as offsets: 6 across its faces, 18 with those across its
/// edges, 26 with those across its corners.
std::span<const VoxelIndex> neighbour_offsets(int count);

/// By how many neighbours levels grow in each round; 0 = no round.
struct Growth {
  int moderate = 26;
  std::array<int, 2> aggressive{26, 26};
};
/// @param in_map the growth of the map's levels, else that of a scan's
Growth growth_of(const Parameters& parameters, bool in_map);

/// Grows levels from the conservative voxels of `frontier`. `spread(frontier, neighbours, level)`
/// gives `level` to those neighbours of the frontier that have none yet, and returns them.
template <class Frontier, class Spread>
void grow_levels(const Growth& growth, Frontier frontier, Spread&& spread) {
  frontier = spread(frontier, growth.moderate, Level::kModerate);
  for (const int neighbours : growth.aggressive) {
    if (neighbours > 0) frontier = spread(frontier, neighbours, Level::kAggressive);
  }
}

}  // namespace raymoval::freedom_method
