// SPDX-License-Identifier: MIT
// Compiled for each instruction set, only for the instruction that counts bits.
#include "methods/raymoval/kernels/occupancy_map.h"

#include "core/simd/compiled_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/raymoval/kernels/box_cover.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
//
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace raymoval::raymoval_method {
namespace HWY_NAMESPACE {
namespace {

constexpr std::uint64_t kEveryByte = 0x0101010101010101ULL;

/// Box x0 .. x1, y0 .. y1 and, as a mask of one byte, z.
struct Candidate {
  int x0, x1, y0, y1;
  std::uint64_t column;  ///< Occupied z of each column.

  /// The box's voxels in each of its words.
  [[nodiscard]] std::uint64_t slice() const {
    const std::uint64_t rows = kEveryByte >> (8 * (7 - (y1 - y0))) << (8 * y0);
    return rows * column;
  }
};

bool holds(const Brick& brick, int x, std::uint64_t slice) {
  return (brick.occupied[static_cast<std::size_t>(x)] & slice) == slice;
}

void grow_x(const Brick& brick, Candidate& box) {
  const std::uint64_t slice = box.slice();
  while (box.x0 > 0 && holds(brick, box.x0 - 1, slice)) --box.x0;
  while (box.x1 < 7 && holds(brick, box.x1 + 1, slice)) ++box.x1;
}

void grow_y(const Brick& brick, Candidate& box) {
  std::uint64_t common = ~std::uint64_t{0};
  for (int x = box.x0; x <= box.x1; ++x) common &= brick.occupied[static_cast<std::size_t>(x)];
  const auto free = [&](int y) { return (common >> (8 * y) & box.column) == box.column; };
  while (box.y0 > 0 && free(box.y0 - 1)) --box.y0;
  while (box.y1 < 7 && free(box.y1 + 1)) ++box.y1;
}

/// The longest run of set bits of `line` around `seed`, one of them.
std::uint64_t run_around(std::uint64_t line, std::uint64_t seed) {
  std::uint64_t run = seed;
  while ((run << 1 & line & ~run) != 0) run |= run << 1 & line;
  while ((run >> 1 & line & ~run) != 0) run |= run >> 1 & line;
  return run;
}

int newly_covered(const Brick& left, const Candidate& box) {
  int count = 0;
  const std::uint64_t slice = box.slice();
  for (int x = box.x0; x <= box.x1; ++x) {
    count += std::popcount(left.occupied[static_cast<std::size_t>(x)] & slice);
  }
  return count;
}

/// A box around the lowest voxel of word `x` of `left`: the voxel and the run of voxels above and
/// below it, grown along x and then y.
Candidate box_along_x(const Brick& brick, const Brick& left, int x) {
  const std::uint64_t word = left.occupied[static_cast<std::size_t>(x)];
  const int y = std::countr_zero(word) / 8;
  const std::uint64_t seed = std::uint64_t{1} << (std::countr_zero(word) % 8);
  const std::uint64_t line = brick.occupied[static_cast<std::size_t>(x)] >> (8 * y) & 0xFF;
  Candidate box{x, x, y, y, run_around(line, seed)};
  grow_x(brick, box);
  grow_y(brick, box);
  return box;
}

/// The same, or grown along y and then x if that covers more.
Candidate better_box(const Brick& brick, const Brick& left, int x) {
  const Candidate one = box_along_x(brick, left, x);
  const int y = std::countr_zero(left.occupied[static_cast<std::size_t>(x)]) / 8;
  Candidate other{x, x, y, y, one.column};
  grow_y(brick, other);
  grow_x(brick, other);
  return newly_covered(left, other) > newly_covered(left, one) ? other : one;
}

void take_out(const Candidate& box, Brick& left) {
  const std::uint64_t slice = box.slice();
  for (int x = box.x0; x <= box.x1; ++x) left.occupied[static_cast<std::size_t>(x)] &= ~slice;
}

}  // namespace

void cover_all(const Brick& brick, std::vector<BrickBox>& boxes) {
  Brick left = brick;
  for (int x = 0; x < Brick::kSide; ++x) {
    while (left.occupied[static_cast<std::size_t>(x)] != 0) {
      const Candidate box = better_box(brick, left, x);
      take_out(box, left);
      boxes.push_back(BrickBox::from({box.x0, box.y0, std::countr_zero(box.column)},
                                     {box.x1, box.y1, 63 - std::countl_zero(box.column)}));
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace raymoval::raymoval_method
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "core/simd/instruction_sets.h"

namespace raymoval::raymoval_method {

HWY_EXPORT(cover_all);

void cover_with_boxes(const Brick& brick, std::vector<BrickBox>& boxes) {
  boxes.clear();
  RAYMOVAL_BEST_KERNEL(cover_all)(brick, boxes);
}

BrickBox tight_box(const Brick& brick) {
  std::array<int, 3> first{7, 0, 0}, last{0, 0, 0};
  std::uint64_t all = 0;
  for (int x = 0; x < Brick::kSide; ++x) {
    const std::uint64_t word = brick.occupied[static_cast<std::size_t>(x)];
    if (word == 0) continue;
    if (x < first[0]) first[0] = x;
    last[0] = x;
    all |= word;
  }
  first[1] = std::countr_zero(all) / 8;
  last[1] = (63 - std::countl_zero(all)) / 8;
  std::uint64_t column = all | all >> 32;
  column |= column >> 16;
  column |= column >> 8;
  column &= 0xFF;
  first[2] = std::countr_zero(column);
  last[2] = 63 - std::countl_zero(column);
  return BrickBox::from(first, last);
}

}  // namespace raymoval::raymoval_method
#endif
