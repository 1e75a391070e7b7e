// SPDX-License-Identifier: MIT
#include "eval/lattice/cell_lattice.h"

#include <algorithm>

#include "core/error.h"
#include "core/morton.h"

namespace raymoval {
namespace {

/// The brick's place on a Morton curve.
std::uint64_t curve_of(VoxelKey brick) {
  return spread_bits(brick) | spread_bits(brick >> kVoxelBits) << 1 |
         spread_bits(brick >> (2 * kVoxelBits)) << 2;
}

}  // namespace

CellLattice::CellLattice(const CellSet& cells) {
  bricks_.reserve(cells.bricks_.size());
  for (const auto& [brick, bits] : cells.bricks_) bricks_.push_back({brick, bits, 0});
  std::sort(bricks_.begin(), bricks_.end(),
            [](const Brick& a, const Brick& b) { return curve_of(a.key) < curve_of(b.key); });
  positions_.reserve(bricks_.size());
  for (Brick& brick : bricks_) {
    brick.first = static_cast<Number>(size_);
    positions_.emplace(brick.key, static_cast<std::uint32_t>(&brick - bricks_.data()));
    size_ += static_cast<std::size_t>(std::popcount(brick.bits));
    if (size_ >= kNone) {
      throw DataError(
          "the map has too many cells: expected fewer than 4,294,967,295. Use fewer scans or "
          "larger voxels.");
    }
  }
}

}  // namespace raymoval
