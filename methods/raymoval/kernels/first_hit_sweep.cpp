// SPDX-License-Identifier: MIT
// The second part of the sweep (see KERNELS.md), written once for any vector width: the first hits
// of a column of bins from the boxes of the bricks that it sees.
#include "methods/raymoval/kernels/first_hit_sweep.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/simd/compiled_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/raymoval/kernels/first_hit_sweep.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
//
#include "methods/raymoval/kernels/first_hit_boxes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace raymoval::raymoval_method::sweep {
namespace HWY_NAMESPACE {
namespace {

/// One bit per lane.
HWY_INLINE std::uint32_t mask_bits(hn::Mask<Floats> mask) {
  std::uint64_t bytes = 0;
  hn::StoreMaskBits(Floats(), mask, reinterpret_cast<std::uint8_t*>(&bytes));
  return static_cast<std::uint32_t>(bytes);
}

/// One column's directions and ranges; kept small enough for the nearest cache. It has only the
/// wanted rows, its lines. They are padded to whole groups with copies of the last line, which are
/// never open.
struct Column {
  F inverse_a, inverse_b;  ///< 1 / the column's horizontal direction, along the two level axes.
  std::array<const float*, 3> inverse;  ///< 1 / direction of each line.
  float* depth;                         ///< The range of each line.
  const std::int32_t* row;              ///< The row of each line, ascending.
  std::size_t lines;
  const std::uint64_t* wanted;  ///< The wanted rows, see `WantedBins`.
  const std::uint32_t* before;  ///< Lines before each word of `wanted`.

  /// The number of lines below a row.
  [[nodiscard]] std::size_t lines_below(std::size_t at) const {
    const std::uint64_t rest = wanted[at / 64] & ~(~std::uint64_t{0} << at % 64);
    return before[at / 64] + static_cast<std::size_t>(std::popcount(rest));
  }
};

float away_from_zero(double value) {
  constexpr double kTiny = 1e-12;
  return static_cast<float>(std::abs(value) < kTiny ? (value < 0.0 ? -kTiny : kTiny) : value);
}

/// Lists the wanted rows of column `i`.
void list_lines(const Frame& frame, int i, Scratch& scratch, Column& column) {
  const hn::RebindToSigned<Floats> d;
  const std::size_t lanes = hn::Lanes(d);
  column.wanted = frame.wanted->column(i);
  std::int32_t* row = scratch.row.data();
  std::size_t count = 0;
  for (std::size_t word = 0; word < frame.wanted->words_a_column(); ++word) {
    scratch.before[word] = static_cast<std::uint32_t>(count);
    for (std::size_t bit = 0; bit < 64; bit += lanes) {
      const std::uint64_t left = column.wanted[word] >> bit;
      if (left == 0) break;
      const auto mask = hn::LoadMaskBits(d, reinterpret_cast<const std::uint8_t*>(&left));
      const auto rows = hn::Iota(d, static_cast<std::int32_t>(64 * word + bit));
      hn::StoreU(hn::Compress(rows, mask), d, row + count);
      count += hn::CountTrue(d, mask);
    }
  }
  const std::size_t padded = (count + kGroup - 1) / kGroup * kGroup;
  if (count > 0) std::fill(row + count, row + padded, row[count - 1]);
  column.row = row;
  column.before = scratch.before.data();
  column.lines = count;
}

/// Eqs 4-6 for column `i`: in double, so that nearly level rays keep their exact inclination.
Column start_column(const Frame& frame, int i, Scratch& scratch) {
  const GridTables& grid = *frame.grid;
  const hn::CappedTag<double, kGroup / 2> wide;
  const hn::Rebind<float, decltype(wide)> narrow;
  const hn::Rebind<std::int32_t, decltype(wide)> short_row;
  const hn::RebindToSigned<decltype(wide)> long_row;
  const Floats d;
  Column column;
  list_lines(frame, i, scratch, column);
  const std::size_t padded = (column.lines + kGroup - 1) / kGroup * kGroup;
  const double cosine = grid.azimuth_cosine[static_cast<std::size_t>(i)];
  const double sine = grid.azimuth_sine[static_cast<std::size_t>(i)];
  std::array<double, 3> level;
  std::array<float*, 3> out;
  for (std::size_t k = 0; k < 3; ++k) {
    level[k] = cosine * frame.x_axis[k] + sine * frame.y_axis[k];
    column.inverse[k] = out[k] =
        scratch.directions.data() + k * static_cast<std::size_t>(grid.padded_rows);
  }
  for (std::size_t j = 0; j < padded; j += hn::Lanes(wide)) {
    const auto row = hn::PromoteTo(long_row, hn::Load(short_row, column.row + j));
    const auto flat = hn::GatherIndex(wide, grid.elevation_cosine.data(), row);
    const auto steep = hn::GatherIndex(wide, grid.elevation_sine.data(), row);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto part = hn::Mul(flat, hn::Set(wide, level[k]));
      const auto rest = hn::Mul(steep, hn::Set(wide, frame.up[k]));
      hn::Store(hn::DemoteTo(narrow, hn::Add(part, rest)), narrow, out[k] + j);
    }
  }
  const F tiny = number(1e-12);
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t j = 0; j < padded; j += hn::Lanes(d)) {
      const F value = hn::Load(d, out[k] + j);
      const F safe = hn::IfThenElse(hn::Lt(hn::Abs(value), tiny), hn::CopySign(tiny, value), value);
      hn::Store(hn::Div(number(1.0), safe), d, out[k] + j);
    }
  }
  column.inverse_a =
      number(1.0 / away_from_zero(level[static_cast<std::size_t>(frame.level_axes[0])]));
  column.inverse_b =
      number(1.0 / away_from_zero(level[static_cast<std::size_t>(frame.level_axes[1])]));
  column.depth = scratch.depth.data();
  const float farthest =
      std::nextafter(frame.maximum_range, std::numeric_limits<float>::infinity());
  std::fill(column.depth, column.depth + column.lines, farthest);
  std::fill(column.depth + column.lines, column.depth + padded, -1.0F);  // Never open.
  return column;
}

/// Finds for each box whether the column's half plane crosses it, and the distances from the axis
/// at its lowest and its highest elevation.
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

/// Distances at which rays enter and leave a box.
struct Crossing {
  F enter, leave;
};

/// Exact slab test of one box with a vector of rays. It uses only products and comparisons, which
/// all instruction sets round equally.
HWY_INLINE Crossing cross_box(const float* box, const Rays& rays) {
  const Floats d;
  const auto at = [&](std::size_t field, std::size_t axis) {
    return hn::Mul(hn::Set(d, box[(field + axis) * kGroup]), rays.inverse[axis]);
  };
  return {hn::Max(hn::Max(at(kNear, 0), at(kNear, 1)), at(kNear, 2)),
          hn::Min(hn::Min(at(kFar, 0), at(kFar, 1)), at(kFar, 2))};
}

HWY_INLINE F nearer_hit(const float* box, const Rays& rays, F minimum, F depth) {
  const Crossing crossing = cross_box(box, rays);
  const auto entered =
      hn::And(hn::Le(crossing.enter, crossing.leave), hn::Ge(crossing.enter, minimum));
  return hn::IfThenElse(hn::And(entered, hn::Lt(crossing.enter, depth)), crossing.enter, depth);
}

void sweep_brick(const Frame& frame, const Column& column, const ColumnEntry& entry,
                 Scratch& scratch) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  const F nearest = hn::Set(d, entry.nearest), minimum = hn::Set(d, frame.minimum_range);
  const float* boxes = nullptr;
  std::size_t groups = 0;
  const std::size_t first = column.lines_below(entry.first_row);
  const std::size_t end = column.lines_below(entry.last_row + std::size_t{1});
  if (first == end) return;  // None of the rows that see the brick is wanted.
  for (std::size_t line = first / lanes * lanes; line < end; line += lanes) {
    F depth = hn::Load(d, column.depth + line);
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
    const auto row_of = [&](std::size_t at) { return static_cast<std::size_t>(column.row[at]); };
    const float below = frame.grid->tangent_below[row_of(line)];
    const float above = frame.grid->tangent_above[row_of(line + lanes - 1)];
    const Rays rays{{hn::Load(d, column.inverse[0] + line), hn::Load(d, column.inverse[1] + line),
                     hn::Load(d, column.inverse[2] + line)}};
    for (std::size_t g = 0; g < groups; ++g) {
      if (scratch.crossing[g] == 0) continue;
      const float* group = boxes + g * kGroupFloats;
      std::uint32_t left =
          scratch.crossing[g] &
          boxes_between(group, scratch.bounds.data() + g * 2 * kGroup, below, above);
      for (; left != 0; left &= left - 1) {
        const float* box = group + std::countr_zero(left);
        depth = nearer_hit(box, rays, minimum, depth);
      }
    }
    hn::Store(depth, d, column.depth + line);
  }
}

/// Writes column `i` into the image.
void write_column(const Frame& frame, int i, const Column& column, float* range) {
  for (std::size_t line = 0; line < column.lines; ++line) {
    const float value = column.depth[line];
    range[static_cast<std::ptrdiff_t>(column.row[line]) * frame.grid->columns + i] =
        value > frame.maximum_range ? std::numeric_limits<float>::infinity() : value;
  }
}

void prepare_scratch(const Frame& frame, Scratch& scratch) {
  const auto rows = static_cast<std::size_t>(frame.grid->padded_rows);
  scratch.pieces.require(6 * kMostPieces);
  scratch.bounds.require(2 * kMostPieces);
  scratch.crossing.resize(kMostPieces / kGroup);
  scratch.row.require(rows + kGroup);  // Vectors are stored beyond the end.
  scratch.before.resize(frame.wanted->words_a_column());
  scratch.directions.require(3 * rows);
  scratch.depth.require(rows);
  scratch.expanded.assign(frame.bricks->count, {});
  scratch.boxes_used = 0;
  scratch.frame = frame.number;
}

}  // namespace

void sweep_all(const Frame& frame, const ColumnLists& lists, int begin, int end, Scratch& scratch,
               float* range) {
  if (scratch.frame != frame.number) prepare_scratch(frame, scratch);
  for (int i = begin; i < end; ++i) {
    const auto at = static_cast<std::size_t>(i - lists.begin);
    const Column column = start_column(frame, i, scratch);
    for (std::uint32_t e = lists.starts[at]; e < lists.starts[at + 1]; ++e) {
      sweep_brick(frame, column, lists.entries[e], scratch);
    }
    write_column(frame, i, column, range);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace raymoval::raymoval_method::sweep
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "core/simd/instruction_sets.h"

namespace raymoval::raymoval_method::sweep {

HWY_EXPORT(sweep_all);

void sweep_columns(const Frame& frame, const ColumnLists& lists, int begin, int end,
                   Scratch& scratch, float* range) {
  RAYMOVAL_BEST_KERNEL(sweep_all)(frame, lists, begin, end, scratch, range);
}

void BrickList::require(std::size_t bricks) {
  const std::size_t padded = (bricks + kGroup - 1) / kGroup * kGroup;
  for (std::size_t k = 0; k < 3; ++k) {
    low[k].require(padded);
    high[k].require(padded);
    plane[k].require(padded);
  }
  slot.require(padded);
  nearest.require(padded);
  first_column.require(padded);
  last_column.require(padded);
  first_row.require(padded);
  last_row.require(padded);
}

}  // namespace raymoval::raymoval_method::sweep
#endif
