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
#include <bit>
#include <cstring>

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

/// Fields of a group of boxes as the sweep wants them, each of kGroup numbers.
enum Field : std::size_t {
  kHeightLow,  ///< Along the sensor's up axis.
  kHeightHigh,
  kLowA,  ///< Along the two level axes, what height can shift included.
  kHighA,
  kLowB,
  kHighB,
  kNear,               ///< The walls on the sensor's side, x, y, z.
  kFar = kNear + 3,    ///< The other ones.
  kPacked = kFar + 3,  ///< The bits of the BrickBox.
  kFields,
};
constexpr std::size_t kGroupFloats = kFields * kGroup;

/// Boxes of one brick from the sensor, one array a coordinate.
struct Pieces {
  float* values;
  std::size_t capacity;
  std::size_t count = 0;
  [[nodiscard]] float* packed() const { return values + 6 * capacity; }
  [[nodiscard]] float* low(std::size_t axis) const { return values + axis * capacity; }
  [[nodiscard]] float* high(std::size_t axis) const { return values + (axis + 3) * capacity; }
};
/// A brick has at most 256 boxes, each cut into 8 at most.
constexpr std::size_t kMostPieces = 2048;

/// Adds a box, cut at the planes through the sensor, so that for every piece it is known which of
/// its walls a ray can enter by.
void add_piece(Pieces& pieces, BrickBox box, std::array<float, 3> low, std::array<float, 3> high) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(low[k] < 0.0F && high[k] > 0.0F)) continue;
    std::array<float, 3> cut = high;
    cut[k] = 0.0F;
    add_piece(pieces, box, low, cut);
    low[k] = 0.0F;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    pieces.low(k)[pieces.count] = low[k];
    pieces.high(k)[pieces.count] = high[k];
  }
  pieces.packed()[pieces.count] = std::bit_cast<float>(box.packed);
  ++pieces.count;
}

/// The boxes of a brick that no plane through the sensor cuts.
void load_boxes(const Frame& frame, std::size_t brick, Pieces& pieces) {
  const Ints d;
  const hn::RebindToUnsigned<Floats> bits;
  const auto boxes = frame.map->boxes(frame.bricks->slot[brick]);
  std::size_t i = 0;
  for (; i < boxes.size(); i += hn::Lanes(d)) {
    alignas(kSimdAlignment) std::uint32_t packed[kGroup] = {};
    std::memcpy(packed, boxes.data() + i,
                std::min(hn::Lanes(d), boxes.size() - i) * sizeof(std::uint32_t));
    auto word = hn::Load(bits, packed);
    hn::Store(hn::BitCast(Floats(), word), Floats(), pieces.packed() + i);
    const auto next = [&] {
      const auto value = hn::BitCast(d, hn::And(word, hn::Set(bits, 7U)));
      word = hn::ShiftRight<3>(word);
      return value;
    };
    for (std::size_t k = 0; k < 3; ++k) {
      const float* walls = frame.planes[k] + frame.bricks->plane[k][brick];
      hn::Store(hn::GatherIndex(Floats(), walls, next()), Floats(), pieces.low(k) + i);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const float* walls = frame.planes[k] + frame.bricks->plane[k][brick] + 1;
      hn::Store(hn::GatherIndex(Floats(), walls, next()), Floats(), pieces.high(k) + i);
    }
  }
  pieces.count = boxes.size();
}

/// The boxes of a brick that the sensor stands beside in some axis.
void cut_boxes(const Frame& frame, std::size_t brick, Pieces& pieces) {
  std::array<const float*, 3> walls;
  for (std::size_t k = 0; k < 3; ++k) walls[k] = frame.planes[k] + frame.bricks->plane[k][brick];
  for (const BrickBox& box : frame.map->boxes(frame.bricks->slot[brick])) {
    std::array<float, 3> low, high;
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = walls[k][box.first(k)];
      high[k] = walls[k][box.last(k) + 1];
    }
    add_piece(pieces, box, low, high);
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

/// Section "Safe bounds" of README.md: pieces i .. i + Lanes - 1 into one group.
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
  hn::Store(hn::Load(d, pieces.packed() + i), d, group + kPacked * kGroup);
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

/// Whether some of the brick's voxels may be entered before the minimum range.
bool reaches_minimum(const Frame& frame, float nearest) {
  return nearest < frame.minimum_range;
}

void expand(const Frame& frame, std::size_t brick, Scratch& scratch) {
  Pieces pieces{scratch.pieces.data(), kMostPieces};
  bool beside = false;
  for (std::size_t k = 0; k < 3; ++k) {
    beside |= frame.bricks->low[k][brick] < 0.0F && frame.bricks->high[k][brick] > 0.0F;
  }
  if (beside) {
    cut_boxes(frame, brick, pieces);
  } else {
    load_boxes(frame, brick, pieces);
  }
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
