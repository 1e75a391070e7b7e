// SPDX-License-Identifier: MIT
// The kernels of the brick-column sweep (see first_hit.h), written once for any vector width.
// Included once for each instruction set.
#if defined(RAYMOVAL_FIRST_HIT_SWEEP_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYMOVAL_FIRST_HIT_SWEEP_INL
#undef RAYMOVAL_FIRST_HIT_SWEEP_INL
#else
#define RAYMOVAL_FIRST_HIT_SWEEP_INL
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "hwy/contrib/math/math-inl.h"
#include "hwy/highway.h"
#include "methods/raymoval/first_hit_sweep.h"

HWY_BEFORE_NAMESPACE();
namespace raymoval::sweep {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, kGroup>;
using Ints = hn::RebindToSigned<Floats>;
using F = hn::Vec<Floats>;

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

F number(double value) {
  return hn::Set(Floats(), static_cast<float>(value));
}

/// One bit a lane.
HWY_INLINE std::uint32_t mask_bits(hn::Mask<Floats> mask) {
  std::uint64_t bytes = 0;
  hn::StoreMaskBits(Floats(), mask, reinterpret_cast<std::uint8_t*>(&bytes));
  return static_cast<std::uint32_t>(bytes);
}

F atan2_of(F y, F x) {
  const Floats d;
  const F steep = hn::Abs(y), flat = hn::Abs(x);
  const F small = hn::Min(steep, flat);
  const F large = hn::Max(hn::Max(steep, flat), number(1e-30));
  F angle = hn::Atan(d, hn::Div(small, large));
  angle = hn::IfThenElse(hn::Gt(steep, flat), hn::Sub(number(1.5707963267948966), angle), angle);
  angle = hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Sub(number(3.141592653589793), angle), angle);
  return hn::CopySign(angle, y);
}

/// A brick's tight box as centre and half sides.
struct Solid {
  std::array<F, 3> centre, half;
};

Solid load_solid(const Frame& frame, std::size_t i) {
  const Floats d;
  const F slack = hn::Set(d, frame.slack);
  Solid solid;
  for (std::size_t k = 0; k < 3; ++k) {
    const F low = hn::Load(d, frame.bricks->low[k].data() + i);
    const F high = hn::Load(d, frame.bricks->high[k].data() + i);
    solid.centre[k] = hn::Mul(number(0.5), hn::Add(low, high));
    solid.half[k] = hn::MulAdd(number(0.5), hn::Sub(high, low), slack);
  }
  return solid;
}

F dot(const std::array<double, 3>& axis, const std::array<F, 3>& values) {
  return hn::MulAdd(number(axis[0]), values[0],
                    hn::MulAdd(number(axis[1]), values[1], hn::Mul(number(axis[2]), values[2])));
}

/// How a solid stands around the sensor's upright axis.
struct Footprint {
  F across_x, across_y;         ///< Centre, along the sensor's x and y.
  F rho_low, rho_high;          ///< Distance from the axis.
  F tangent_low, tangent_high;  ///< Of the angle from the centre's azimuth.
  hn::Mask<Floats> around_axis;
};

Footprint footprint_of(const Frame& frame, const Solid& solid) {
  const Floats d;
  Footprint foot;
  foot.across_x = dot(frame.x_axis, solid.centre);
  foot.across_y = dot(frame.y_axis, solid.centre);
  const F distance =
      hn::Sqrt(hn::MulAdd(foot.across_x, foot.across_x, hn::Mul(foot.across_y, foot.across_y)));
  const F scale = hn::Div(number(1.0), hn::Max(distance, number(1e-6)));
  const F unit_x = hn::Mul(foot.across_x, scale), unit_y = hn::Mul(foot.across_y, scale);
  std::array<F, 3> along, aside;
  F along_reach = hn::Zero(d), aside_reach = hn::Zero(d);
  for (std::size_t k = 0; k < 3; ++k) {
    const F x = hn::Mul(number(frame.x_axis[k]), solid.half[k]);
    const F y = hn::Mul(number(frame.y_axis[k]), solid.half[k]);
    along[k] = hn::MulAdd(x, unit_x, hn::Mul(y, unit_y));
    aside[k] = hn::Sub(hn::Mul(y, unit_x), hn::Mul(x, unit_y));
    along_reach = hn::Add(along_reach, hn::Abs(along[k]));
    aside_reach = hn::Add(aside_reach, hn::Abs(aside[k]));
  }
  const F front = hn::Sub(distance, along_reach);
  foot.around_axis = hn::Lt(front, number(1e-3));
  foot.rho_low = hn::Max(front, number(1e-6));
  const F back = hn::Add(distance, along_reach);
  foot.rho_high = hn::Sqrt(hn::MulAdd(back, back, hn::Mul(aside_reach, aside_reach)));
  foot.tangent_low = foot.tangent_high = hn::Zero(d);
  for (int corner = 0; corner < 4; ++corner) {
    const auto signed_sum = [&](const std::array<F, 3>& side) {
      const F y = (corner & 1) != 0 ? hn::Neg(side[1]) : side[1];
      const F z = (corner & 2) != 0 ? hn::Neg(side[2]) : side[2];
      return hn::Add(side[0], hn::Add(y, z));
    };
    const F a = signed_sum(along), c = signed_sum(aside);
    const F one = hn::Div(c, hn::Max(hn::Add(distance, a), number(1e-6)));
    const F other = hn::Div(hn::Neg(c), hn::Max(hn::Sub(distance, a), number(1e-6)));
    foot.tangent_low = hn::Min(foot.tangent_low, hn::Min(one, other));
    foot.tangent_high = hn::Max(foot.tangent_high, hn::Max(one, other));
  }
  return foot;
}

/// Columns whose centres lie within the footprint, a little more rather than less.
void find_columns(const Frame& frame, const Footprint& foot, std::size_t i) {
  const Floats d;
  const F azimuth = hn::Add(atan2_of(foot.across_y, foot.across_x), number(3.141592653589793));
  const F per_radian = hn::Set(d, frame.grid->inverse_azimuth_step);
  const F low = hn::Add(azimuth, hn::Atan(d, foot.tangent_low));
  const F high = hn::Add(azimuth, hn::Atan(d, foot.tangent_high));
  const F all = number(frame.grid->columns - 1);
  F first = hn::Add(hn::Floor(hn::MulSub(low, per_radian, number(0.52))), number(1.0));
  F last = hn::Floor(hn::MulSub(high, per_radian, number(0.48)));
  const auto every = hn::Or(foot.around_axis, hn::Ge(hn::Sub(last, first), all));
  first = hn::IfThenElse(every, hn::Zero(d), first);
  last = hn::IfThenElse(every, all, last);
  hn::Store(hn::ConvertTo(Ints(), first), Ints(), frame.bricks->first_column.data() + i);
  hn::Store(hn::ConvertTo(Ints(), last), Ints(), frame.bricks->last_column.data() + i);
}

/// Smallest and largest h / rho for h_low <= h <= h_high and rho_low <= rho <= rho_high.
F lowest_tangent(F height, F rho_low, F rho_high) {
  return hn::Div(height, hn::IfThenElse(hn::Lt(height, hn::Zero(Floats())), rho_low, rho_high));
}
F highest_tangent(F height, F rho_low, F rho_high) {
  return hn::Div(height, hn::IfThenElse(hn::Lt(height, hn::Zero(Floats())), rho_high, rho_low));
}

/// Rows whose centres lie within the heights of the solid. @return whether there is one
hn::Mask<Floats> find_rows(const Frame& frame, const Solid& solid, const Footprint& foot,
                           std::size_t i) {
  const Floats d;
  const F height = dot(frame.up, solid.centre);
  F reach = hn::Zero(d);
  for (std::size_t k = 0; k < 3; ++k) {
    reach = hn::MulAdd(number(std::abs(frame.up[k])), solid.half[k], reach);
  }
  const F low = lowest_tangent(hn::Sub(height, reach), foot.rho_low, foot.rho_high);
  const F high = highest_tangent(hn::Add(height, reach), foot.rho_low, foot.rho_high);
  const F origin = hn::Set(d, frame.grid->elevation_min);
  const F per_radian = hn::Set(d, frame.grid->inverse_elevation_step);
  const auto row_at = [&](F tangent, double shift) {
    const F row = hn::MulSub(hn::Sub(hn::Atan(d, tangent), origin), per_radian, number(shift));
    return hn::Floor(hn::Min(hn::Max(row, number(-2.0)), number(frame.grid->rows + 1)));
  };
  const F first = hn::Max(hn::Add(row_at(low, 0.55), number(1.0)), hn::Zero(d));
  const F last = hn::Min(row_at(high, 0.45), number(frame.grid->rows - 1));
  hn::Store(hn::ConvertTo(Ints(), first), Ints(), frame.bricks->first_row.data() + i);
  hn::Store(hn::ConvertTo(Ints(), last), Ints(), frame.bricks->last_row.data() + i);
  return hn::Le(first, last);
}

/// Distance of the solid from the sensor.
F nearest_of(const Solid& solid) {
  const Floats d;
  F sum = hn::Zero(d);
  for (std::size_t k = 0; k < 3; ++k) {
    const F gap = hn::Max(hn::Sub(hn::Abs(solid.centre[k]), solid.half[k]), hn::Zero(d));
    sum = hn::MulAdd(gap, gap, sum);
  }
  return hn::Mul(hn::Sqrt(sum), number(1.0 - 1e-6));
}

void measure_bricks(const Frame& frame) {
  const Floats d;
  BrickList& bricks = *frame.bricks;
  for (std::size_t i = 0; i < bricks.count; i += hn::Lanes(d)) {
    const Solid solid = load_solid(frame, i);
    const Footprint foot = footprint_of(frame, solid);
    const F nearest = nearest_of(solid);
    hn::Store(nearest, d, bricks.nearest.data() + i);
    find_columns(frame, foot, i);
    const auto seen =
        hn::And(find_rows(frame, solid, foot, i), hn::Le(nearest, hn::Set(d, frame.maximum_range)));
    const auto first = hn::Load(Ints(), bricks.first_column.data() + i);
    const auto none = hn::Set(Ints(), std::numeric_limits<std::int32_t>::max());
    hn::Store(hn::IfThenElse(hn::RebindMask(Ints(), seen), first, none), Ints(),
              bricks.first_column.data() + i);
  }
}

// --- Columns ---------------------------------------------------------------------------------

/// Calls `visit(column)` for the brick's columns within begin .. end - 1.
template <class Visit>
void for_columns(const Frame& frame, std::size_t brick, int begin, int end, Visit&& visit) {
  const int columns = frame.grid->columns;
  const int first = frame.bricks->first_column[brick], last = frame.bricks->last_column[brick];
  for (int turn = -columns; turn <= columns; turn += columns) {
    const int to = std::min(last + turn, end - 1);
    for (int i = std::max(first + turn, begin); i <= to; ++i) visit(i - begin);
  }
}

/// Sorts the bricks into the columns they are seen in, nearest first.
void list_columns(const Frame& frame, int begin, int end, Scratch& scratch) {
  const BrickList& bricks = *frame.bricks;
  auto& starts = scratch.column_begin;
  starts.assign(static_cast<std::size_t>(end - begin) + 2, 0);
  for (const std::uint32_t brick : *frame.order) {
    for_columns(frame, brick, begin, end,
                [&](int i) { ++starts[static_cast<std::size_t>(i) + 2]; });
  }
  for (std::size_t i = 2; i < starts.size(); ++i) starts[i] += starts[i - 1];
  if (scratch.entries.size() < starts.back()) scratch.entries.resize(starts.back());
  for (const std::uint32_t brick : *frame.order) {
    const ColumnEntry entry{brick, static_cast<std::uint16_t>(bricks.first_row[brick]),
                            static_cast<std::uint16_t>(bricks.last_row[brick]),
                            bricks.nearest[brick]};
    for_columns(frame, brick, begin, end,
                [&](int i) { scratch.entries[starts[static_cast<std::size_t>(i) + 1]++] = entry; });
  }
}

// --- Boxes -----------------------------------------------------------------------------------

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

/// Section "Safe bounds" of first_hit.h: pieces i .. i + Lanes - 1 into one group.
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
  const std::size_t step = hn::Lanes(Floats());
  for (std::size_t g = 0; g < groups; ++g) {
    float* group = scratch.boxes.data() + scratch.boxes_used;
    for (std::size_t i = 0; i < kGroup; i += step) {
      store_group(frame, pieces, g * kGroup + i, group + i);
    }
    scratch.boxes_used += kGroupFloats;
  }
}

// --- Sweep -----------------------------------------------------------------------------------

/// One column's directions and ranges; kept small enough for the nearest cache.
struct Column {
  F inverse_a, inverse_b;  ///< 1 / the column's horizontal direction, along the two level axes.
  std::array<const float*, 3> inverse;  ///< 1 / direction of each row.
  float* depth;
};

float away_from_zero(double value) {
  constexpr double kTiny = 1e-12;
  return static_cast<float>(std::abs(value) < kTiny ? (value < 0.0 ? -kTiny : kTiny) : value);
}

/// Eqs 4-6 for column `i`: in double, so that nearly level rays keep their exact inclination.
Column start_column(const Frame& frame, int i, Scratch& scratch, float* depth) {
  const GridTables& grid = *frame.grid;
  const hn::CappedTag<double, kGroup / 2> wide;
  const hn::Rebind<float, decltype(wide)> narrow;
  const Floats d;
  const auto rows = static_cast<std::size_t>(grid.padded_rows);
  const double cosine = grid.azimuth_cosine[static_cast<std::size_t>(i)];
  const double sine = grid.azimuth_sine[static_cast<std::size_t>(i)];
  Column column;
  column.depth = depth;
  std::array<double, 3> level;
  for (std::size_t k = 0; k < 3; ++k) {
    level[k] = cosine * frame.x_axis[k] + sine * frame.y_axis[k];
    float* out = scratch.directions.data() + k * rows;
    column.inverse[k] = out;
    const auto a = hn::Set(wide, level[k]), b = hn::Set(wide, frame.up[k]);
    for (std::size_t j = 0; j < rows; j += hn::Lanes(wide)) {
      const auto part = hn::Mul(hn::LoadU(wide, grid.elevation_cosine.data() + j), a);
      const auto rest = hn::Mul(hn::LoadU(wide, grid.elevation_sine.data() + j), b);
      hn::Store(hn::DemoteTo(narrow, hn::Add(part, rest)), narrow, out + j);
    }
    const F tiny = number(1e-12);
    for (std::size_t j = 0; j < rows; j += hn::Lanes(d)) {
      const F value = hn::Load(d, out + j);
      const F safe = hn::IfThenElse(hn::Lt(hn::Abs(value), tiny), hn::CopySign(tiny, value), value);
      hn::Store(hn::Div(number(1.0), safe), d, out + j);
    }
  }
  column.inverse_a =
      number(1.0 / away_from_zero(level[static_cast<std::size_t>(frame.level_axes[0])]));
  column.inverse_b =
      number(1.0 / away_from_zero(level[static_cast<std::size_t>(frame.level_axes[1])]));
  const float farthest =
      std::nextafter(frame.maximum_range, std::numeric_limits<float>::infinity());
  std::fill(depth, depth + grid.rows, farthest);
  std::fill(depth + grid.rows, depth + grid.padded_rows, -1.0F);  // Never open.
  return column;
}

/// For each box: whether the column's half plane crosses it, and the distances from the axis that
/// belong to its lowest and its highest elevation.
void bound_boxes(const Column& column, const float* group, float* rho, std::uint32_t* crossing) {
  const Floats d;
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < kGroup; i += hn::Lanes(d)) {
    const auto field = [&](std::size_t number) { return hn::Load(d, group + number * kGroup + i); };
    const F a0 = hn::Mul(field(kLowA), column.inverse_a);
    const F a1 = hn::Mul(field(kHighA), column.inverse_a);
    const F b0 = hn::Mul(field(kLowB), column.inverse_b);
    const F b1 = hn::Mul(field(kHighB), column.inverse_b);
    const F in = hn::Max(hn::Max(hn::Min(a0, a1), hn::Min(b0, b1)), number(1e-6));
    const F out = hn::Min(hn::Max(a0, a1), hn::Max(b0, b1));
    const auto below = hn::Lt(field(kHeightLow), hn::Zero(d));
    const auto top_below = hn::Lt(field(kHeightHigh), hn::Zero(d));
    hn::Store(hn::IfThenElse(below, in, out), d, rho + i);
    hn::Store(hn::IfThenElse(top_below, out, in), d, rho + kGroup + i);
    bits |= mask_bits(hn::Le(in, out)) << i;
  }
  *crossing = bits;
}

/// Boxes of a group between two tangents of elevation.
std::uint32_t boxes_between(const float* group, const float* rho, float below, float above) {
  const Floats d;
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < kGroup; i += hn::Lanes(d)) {
    const auto low = hn::Le(hn::Load(d, group + kHeightLow * kGroup + i),
                            hn::Mul(hn::Set(d, above), hn::Load(d, rho + i)));
    const auto high = hn::Ge(hn::Load(d, group + kHeightHigh * kGroup + i),
                             hn::Mul(hn::Set(d, below), hn::Load(d, rho + kGroup + i)));
    bits |= mask_bits(hn::And(low, high)) << i;
  }
  return bits;
}

/// Rays of consecutive rows.
struct Rays {
  std::array<F, 3> inverse;  ///< 1 / direction along each axis.
};

/// Where rays enter and leave a box.
struct Crossing {
  F enter, leave;
};

/// Exact slab test of one box with a vector of rays. Only products and comparisons: every
/// instruction set rounds alike.
HWY_INLINE Crossing cross_box(const float* box, const Rays& rays) {
  const Floats d;
  const auto at = [&](std::size_t field, std::size_t axis) {
    return hn::Mul(hn::Set(d, box[(field + axis) * kGroup]), rays.inverse[axis]);
  };
  return {hn::Max(hn::Max(at(kNear, 0), at(kNear, 1)), at(kNear, 2)),
          hn::Min(hn::Min(at(kFar, 0), at(kFar, 1)), at(kFar, 2))};
}

HWY_INLINE F nearer_hit(const float* box, const Rays& rays, F depth) {
  const Crossing crossing = cross_box(box, rays);
  const auto hit = hn::And(hn::Le(crossing.enter, crossing.leave), hn::Lt(crossing.enter, depth));
  return hn::IfThenElse(hit, crossing.enter, depth);
}

/// The same for the voxels of a box one by one, if entered after the minimum range.
HWY_NOINLINE F nearer_voxel(const Frame& frame, std::size_t brick, std::uint32_t packed,
                            const Rays& rays, F depth) {
  const Floats d;
  const F minimum = hn::Set(d, frame.minimum_range);
  const BrickBox box{packed};
  const auto slab = [&](std::size_t axis, int at) {
    const float* wall = frame.planes[axis] + frame.bricks->plane[axis][brick] + at;
    const F a = hn::Mul(hn::Set(d, wall[0]), rays.inverse[axis]);
    const F b = hn::Mul(hn::Set(d, wall[1]), rays.inverse[axis]);
    return Crossing{hn::Min(a, b), hn::Max(a, b)};
  };
  for (int x = box.first(0); x <= box.last(0); ++x) {
    const Crossing in_x = slab(0, x);
    for (int y = box.first(1); y <= box.last(1); ++y) {
      const Crossing in_y = slab(1, y);
      const F enter_xy = hn::Max(in_x.enter, in_y.enter);
      const F leave_xy = hn::Min(in_x.leave, in_y.leave);
      for (int z = box.first(2); z <= box.last(2); ++z) {
        const Crossing in_z = slab(2, z);
        const F enter = hn::Max(enter_xy, in_z.enter);
        const auto crossed = hn::Le(enter, hn::Min(leave_xy, in_z.leave));
        const auto hit = hn::And(crossed, hn::And(hn::Ge(enter, minimum), hn::Lt(enter, depth)));
        depth = hn::IfThenElse(hit, enter, depth);
      }
    }
  }
  return depth;
}

/// For a box that reaches into the minimum range. Rays that are inside it there may enter its next
/// voxel later.
HWY_INLINE F nearer_hit_after_minimum(const Frame& frame, std::size_t brick, const float* box,
                                      const Rays& rays, F depth) {
  const Floats d;
  const F minimum = hn::Set(d, frame.minimum_range);
  const Crossing crossing = cross_box(box, rays);
  const auto crossed = hn::Le(crossing.enter, crossing.leave);
  const auto early = hn::Lt(crossing.enter, minimum);
  const auto inside = hn::And(crossed, hn::And(early, hn::Ge(crossing.leave, minimum)));
  const auto hit = hn::And(crossed, hn::Lt(crossing.enter, depth));
  depth = hn::IfThenElse(hn::AndNot(early, hit), crossing.enter, depth);
  if (hn::AllFalse(d, inside)) return depth;
  return nearer_voxel(frame, brick, std::bit_cast<std::uint32_t>(box[kPacked * kGroup]), rays,
                      depth);
}

template <bool kAtMinimum>
void sweep_brick(const Frame& frame, const Column& column, const ColumnEntry& entry,
                 Scratch& scratch) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  const F nearest = hn::Set(d, entry.nearest);
  const float* boxes = nullptr;
  std::size_t groups = 0;
  for (std::size_t row = entry.first_row / lanes * lanes; row <= entry.last_row; row += lanes) {
    F depth = hn::Load(d, column.depth + row);
    if (hn::AllFalse(d, hn::Gt(depth, nearest))) continue;
    if (boxes == nullptr) {
      if (!scratch.expanded[entry.brick].done) expand(frame, entry.brick, scratch);
      const Scratch::Expanded& expanded = scratch.expanded[entry.brick];
      boxes = scratch.boxes.data() + expanded.begin;
      groups = (expanded.boxes + kGroup - 1) / kGroup;
      for (std::size_t g = 0; g < groups; ++g) {
        bound_boxes(column, boxes + g * kGroupFloats, scratch.bounds.data() + g * 2 * kGroup,
                    &scratch.crossing[g]);
      }
      // The last group's padding misses.
      scratch.crossing[groups - 1] &= (1U << ((expanded.boxes - 1) % kGroup + 1)) - 1U;
    }
    const std::size_t last = std::min(row + lanes, static_cast<std::size_t>(frame.grid->rows)) - 1;
    const float below = frame.grid->tangent_below[row], above = frame.grid->tangent_above[last];
    const Rays rays{{hn::Load(d, column.inverse[0] + row), hn::Load(d, column.inverse[1] + row),
                     hn::Load(d, column.inverse[2] + row)}};
    for (std::size_t g = 0; g < groups; ++g) {
      if (scratch.crossing[g] == 0) continue;
      const float* group = boxes + g * kGroupFloats;
      std::uint32_t left =
          scratch.crossing[g] &
          boxes_between(group, scratch.bounds.data() + g * 2 * kGroup, below, above);
      for (; left != 0; left &= left - 1) {
        const float* box = group + std::countr_zero(left);
        if constexpr (kAtMinimum) {
          depth = nearer_hit_after_minimum(frame, entry.brick, box, rays, depth);
        } else {
          depth = nearer_hit(box, rays, depth);
        }
      }
    }
    hn::Store(depth, d, column.depth + row);
  }
}

/// Turns columns first .. first + count - 1 into rows of the image.
void write_rows(const Frame& frame, int first, int count, const float* depth, float* range) {
  const GridTables& grid = *frame.grid;
  for (int j = 0; j < grid.rows; ++j) {
    float* out = range + static_cast<std::ptrdiff_t>(j) * grid.columns + first;
    for (int i = 0; i < count; ++i) {
      const float value = depth[i * grid.padded_rows + j];
      out[i] = value > frame.maximum_range ? std::numeric_limits<float>::infinity() : value;
    }
  }
}

void prepare_scratch(const Frame& frame, Scratch& scratch) {
  const auto rows = static_cast<std::size_t>(frame.grid->padded_rows);
  scratch.pieces.require(7 * kMostPieces);
  scratch.bounds.require(2 * kMostPieces);
  scratch.crossing.resize(kMostPieces / kGroup);
  scratch.directions.require(3 * rows);
  scratch.depth.require(kGroup * rows);
  scratch.expanded.assign(frame.bricks->count, {});
  scratch.boxes_used = 0;
  std::size_t most = 0;
  for (const std::uint32_t brick : *frame.order) {
    bool beside = false;
    for (std::size_t k = 0; k < 3; ++k) {
      beside |= frame.bricks->low[k][brick] < 0.0F && frame.bricks->high[k][brick] > 0.0F;
    }
    // Cut boxes are rare; a bound that is too high costs address space only.
    const std::size_t boxes = frame.map->boxes(frame.bricks->slot[brick]).size();
    most += ((beside ? 8 : 1) * boxes + kGroup - 1) / kGroup;
  }
  scratch.boxes.require(most * kGroupFloats);
}

void sweep_columns(const Frame& frame, int begin, int end, Scratch& scratch, float* range) {
  list_columns(frame, begin, end, scratch);
  prepare_scratch(frame, scratch);
  constexpr int kBlock = static_cast<int>(kGroup);
  for (int first = begin; first < end; first += kBlock) {
    const int count = std::min(kBlock, end - first);
    for (int i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(first + i - begin);
      const Column column = start_column(frame, first + i, scratch,
                                         scratch.depth.data() + i * frame.grid->padded_rows);
      for (std::uint32_t e = scratch.column_begin[at]; e < scratch.column_begin[at + 1]; ++e) {
        const ColumnEntry& entry = scratch.entries[e];
        if (reaches_minimum(frame, entry.nearest)) {
          sweep_brick<true>(frame, column, entry, scratch);
        } else {
          sweep_brick<false>(frame, column, entry, scratch);
        }
      }
    }
    write_rows(frame, first, count, scratch.depth.data(), range);
  }
}

}  // namespace

Kernels kernels() {
  return {&measure_bricks, &sweep_columns};
}

}  // namespace HWY_NAMESPACE
}  // namespace raymoval::sweep
HWY_AFTER_NAMESPACE();

#endif
