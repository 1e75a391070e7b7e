// SPDX-License-Identifier: MIT
// The boxes of a brick in the form that the sweep needs. Included by first_hit_sweep.cpp once for
// each instruction set.
#if defined(RAYMOVAL_FIRST_HIT_BOXES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYMOVAL_FIRST_HIT_BOXES_INL
#undef RAYMOVAL_FIRST_HIT_BOXES_INL
#else
#define RAYMOVAL_FIRST_HIT_BOXES_INL
#endif

#include <array>

#include "hwy/highway.h"
#include "methods/raymoval/kernels/first_hit_sweep.h"

HWY_BEFORE_NAMESPACE();
namespace raymoval::raymoval_method::sweep {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, kGroup>;
using Ints = hn::RebindToSigned<Floats>;
using F = hn::Vec<Floats>;

F number(double value) {
  return hn::Set(Floats(), static_cast<float>(value));
}

/// Fields of a group of boxes for the sweep, each of kGroup numbers.
enum Field : std::size_t {
  kHeightLow,  ///< Along the sensor's up axis.
  kHeightHigh,
  kLowA,  ///< Along the two level axes, including the shift by height.
  kHighA,
  kLowB,
  kHighB,
  kNear,             ///< The walls on the sensor's side: x, y, z.
  kFar = kNear + 3,  ///< The walls on the other side.
  kFields = kFar + 3,
};
constexpr std::size_t kGroupFloats = kFields * kGroup;

/// Boxes of one brick relative to the sensor, one array per coordinate.
struct Pieces {
  float* values;
  std::size_t capacity;
  std::size_t count = 0;
  [[nodiscard]] float* low(std::size_t axis) const { return values + axis * capacity; }
  [[nodiscard]] float* high(std::size_t axis) const { return values + (axis + 3) * capacity; }
};
/// A brick has at most 256 boxes, each divided into at most 8.
constexpr std::size_t kMostPieces = 2048;

/// Adds a box, divided at the planes through the sensor, so that the walls through which rays enter
/// are known for each piece.
void add_piece(Pieces& pieces, std::array<float, 3> low, std::array<float, 3> high) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(low[k] < 0.0F && high[k] > 0.0F)) continue;
    std::array<float, 3> cut = high;
    cut[k] = 0.0F;
    add_piece(pieces, low, cut);
    low[k] = 0.0F;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    pieces.low(k)[pieces.count] = low[k];
    pieces.high(k)[pieces.count] = high[k];
  }
  ++pieces.count;
}

/// Whether a ray may enter a brick before the minimum range.
bool reaches_minimum(const Frame& frame, std::size_t brick) {
  return frame.bricks->nearest[brick] < frame.minimum_range;
}

/// Adds the boxes of a brick. If the brick reaches into the minimum range, it adds the voxels,
/// because a ray that is inside a box at the minimum range may enter its next voxel later.
void load_boxes(const Frame& frame, std::size_t brick, Pieces& pieces) {
  const auto add = [&](const BrickBox& box) {
    std::array<float, 3> low, high;
    for (std::size_t k = 0; k < 3; ++k) {
      const float* walls = frame.planes[k] + frame.bricks->plane[k][brick];
      low[k] = walls[box.first(k)];
      high[k] = walls[box.last(k) + 1];
    }
    add_piece(pieces, low, high);
  };
  const OccupancyMap::Slot slot = frame.bricks->slot[brick];
  if (!reaches_minimum(frame, brick)) {
    for (const BrickBox& box : frame.map->boxes(slot)) add(box);
    return;
  }
  for (int k = 0; k < 512; ++k) {
    const std::array<int, 3> voxel = {k >> 6, k >> 3 & 7, k & 7};
    if (frame.map->brick(slot).contains(voxel[0], voxel[1], voxel[2])) {
      add(BrickBox::from(voxel, voxel));
    }
  }
}

/// Smallest and largest of up * value for two bounds.
struct Interval {
  F low, high;
};
Interval scaled(double factor, F low, F high) {
  const F a = hn::Mul(number(factor), low), b = hn::Mul(number(factor), high);
  return {hn::Min(a, b), hn::Max(a, b)};
}

/// Section "Bounds" of KERNELS.md: pieces i .. i + Lanes - 1 into one group.
void store_group(const Frame& frame, const Pieces& pieces, std::size_t i, float* group) {
  const Floats d;
  const F slack = hn::Set(d, frame.slack);
  std::array<F, 3> low, high;
  F height_low = hn::Neg(slack), height_high = slack;
  for (std::size_t k = 0; k < 3; ++k) {
    low[k] = hn::Load(d, pieces.low(k) + i);
    high[k] = hn::Load(d, pieces.high(k) + i);
    const Interval part = scaled(frame.up[k], low[k], high[k]);
    height_low = hn::Add(height_low, part.low);
    height_high = hn::Add(height_high, part.high);
    const auto ahead = hn::Ge(low[k], hn::Zero(d));
    hn::Store(hn::IfThenElse(ahead, low[k], high[k]), d, group + (kNear + k) * kGroup);
    hn::Store(hn::IfThenElse(ahead, high[k], low[k]), d, group + (kFar + k) * kGroup);
  }
  hn::Store(height_low, d, group + kHeightLow * kGroup);
  hn::Store(height_high, d, group + kHeightHigh * kGroup);
  for (std::size_t level = 0; level < 2; ++level) {
    const auto k = static_cast<std::size_t>(frame.level_axes[level]);
    const Interval shift = scaled(frame.up[k], height_low, height_high);
    hn::Store(hn::Sub(hn::Sub(low[k], shift.high), slack), d, group + (kLowA + 2 * level) * kGroup);
    hn::Store(hn::Add(hn::Sub(high[k], shift.low), slack), d,
              group + (kHighA + 2 * level) * kGroup);
  }
}

void expand(const Frame& frame, std::size_t brick, Scratch& scratch) {
  Pieces pieces{scratch.pieces.data(), kMostPieces};
  load_boxes(frame, brick, pieces);
  const std::size_t groups = (pieces.count + kGroup - 1) / kGroup;
  scratch.expanded[brick] = {static_cast<std::uint32_t>(scratch.boxes_used),
                             static_cast<std::uint32_t>(pieces.count), true};
  scratch.boxes.require(scratch.boxes_used + groups * kGroupFloats);
  const std::size_t step = hn::Lanes(Floats());
  for (std::size_t g = 0; g < groups; ++g) {
    float* group = scratch.boxes.data() + scratch.boxes_used;
    for (std::size_t i = 0; i < kGroup; i += step) {
      store_group(frame, pieces, g * kGroup + i, group + i);
    }
    scratch.boxes_used += kGroupFloats;
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace raymoval::raymoval_method::sweep
HWY_AFTER_NAMESPACE();

#endif
