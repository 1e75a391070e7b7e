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

CellLattice::CellLattice(CellSet cells) {
  bricks_.reserve(cells.bricks_.size());
  for (const auto& [brick, bits] : cells.bricks_) bricks_.push_back({brick, bits, 0});
  cells.bricks_ = {};
  std::sort(bricks_.begin(), bricks_.end(),
            [](const Brick& a, const Brick& b) { return curve_of(a.key) < curve_of(b.key); });
  const KeyOfBrick key_of{bricks_.data()};
  positions_.reserve(bricks_.size(), key_of);
  for (Brick& brick : bricks_) {
    brick.first = static_cast<Number>(size_);
    (void)positions_.add(brick.key, key_of);
    size_ += static_cast<std::size_t>(std::popcount(brick.bits));
    if (size_ >= kNone) {
      throw DataError(
          "the map has too many cells: expected fewer than 4,294,967,295. Use fewer scans or "
          "larger voxels.");
    }
  }
}

}  // namespace raymoval
