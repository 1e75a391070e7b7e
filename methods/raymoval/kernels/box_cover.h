// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace raymoval::raymoval_method {

/// Voxels of one brick of 8 x 8 x 8: word = x, byte of the word = y, bit of the byte = z.
struct Brick {
  static constexpr int kBits = 3;
  static constexpr int kSide = 1 << kBits;
  static constexpr int kMask = kSide - 1;

  std::array<std::uint64_t, kSide> occupied{};

  /// Coordinates may be those of the world's lattice.
  [[nodiscard]] bool contains(int x, int y, int z) const {
    return (occupied[static_cast<std::size_t>(x & kMask)] & bit(y, z)) != 0;
  }
  void add(int x, int y, int z) { occupied[static_cast<std::size_t>(x & kMask)] |= bit(y, z); }
  static std::uint64_t bit(int y, int z) {
    return std::uint64_t{1} << ((y & kMask) * kSide + (z & kMask));
  }
};

/// Box of voxels within a brick in 18 bits: first and last voxel (inclusive), 3 bits an axis.
struct BrickBox {
  std::uint32_t packed = 0;

  static BrickBox from(const std::array<int, 3>& first, const std::array<int, 3>& last) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits |= static_cast<std::uint32_t>(first[k]) << (3 * k);
      bits |= static_cast<std::uint32_t>(last[k]) << (9 + 3 * k);
    }
    return {bits};
  }
  [[nodiscard]] int first(std::size_t axis) const {
    return static_cast<int>(packed >> (3 * axis) & 7U);
  }
  [[nodiscard]] int last(std::size_t axis) const {
    return static_cast<int>(packed >> (9 + 3 * axis) & 7U);
  }
};

/// Boxes that together hold each occupied voxel of `brick` and no empty one; they may overlap. A
/// ray meets the boxes first where it meets the voxels first, and there are about five times fewer
/// of them. Greedy: from the lowest voxel that is in no box yet, the voxel and the run of voxels
/// above and below it are grown over occupied voxels in either order of axes, and the box that
/// covers more of what is not covered yet is kept.
/// @param boxes replaced
void cover_with_boxes(const Brick& brick, std::vector<BrickBox>& boxes);

/// Mends a cover after voxels were added: appends boxes for `added`, voxels of `brick` that are in
/// no box yet. It has fewer boxes to choose from than a new cover, is several times faster, and
/// gives a few boxes more.
void cover_added(const Brick& brick, const Brick& added, std::vector<BrickBox>& boxes);

/// The same after voxels were removed, and perhaps others added: boxes that hold an empty voxel are
/// dropped first.
void mend_cover(const Brick& brick, std::vector<BrickBox>& boxes);

/// The smallest box that holds all occupied voxels of a brick that has one.
BrickBox tight_box(const Brick& brick);

}  // namespace raymoval::raymoval_method
