// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/sight_kernels.h"

#include <algorithm>
#include <limits>

#include "core/simd/compiled_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/raymoval_plus/evidence/sight_kernels.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
//
#include "hwy/highway.h"
#include "methods/common/vector_angles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace raymoval::raymoval_plus_method::kernels {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Reals = hn::CappedTag<float, kMostLanes>;
using Whole = hn::Rebind<std::int32_t, Reals>;
using R = hn::Vec<Reals>;
using W = hn::Vec<Whole>;

constexpr float kStraight = 3.14159265358979F;

HWY_INLINE R real(float value) {
  return hn::Set(Reals(), value);
}

HWY_INLINE R angle_of(R y, R x) {
  return raymoval::HWY_NAMESPACE::vector_angle(Reals(), y, x);
}

struct Sight {
  R range;
  W column, row;
};

HWY_INLINE Sight sight_of(const SightGrid& grid, const SightPlaces& places, R px, R py, R pz) {
  R at[3];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float* const turn = places.rotation.data() + 3 * axis;
    const R x = hn::Mul(real(turn[0]), px), y = hn::Mul(real(turn[1]), py);
    at[axis] =
        hn::Add(hn::Add(hn::Add(x, y), hn::Mul(real(turn[2]), pz)), real(places.translation[axis]));
  }
  const R level = hn::Add(hn::Mul(at[0], at[0]), hn::Mul(at[1], at[1]));
  const R range = hn::Sqrt(hn::Add(level, hn::Mul(at[2], at[2])));
  const R azimuth = hn::Add(angle_of(at[1], at[0]), real(kStraight));
  const R elevation = angle_of(at[2], hn::Sqrt(level));
  const Whole whole;
  const W column = hn::ConvertTo(whole, hn::Mul(azimuth, real(grid.columns_per_radian)));
  const W row = hn::ConvertTo(whole, hn::Floor(hn::Mul(hn::Sub(elevation, real(grid.elevation_min)),
                                                       real(grid.rows_per_radian))));
  return {range, hn::Min(column, hn::Set(whole, grid.columns - 1)), row};
}

/// Calls `visit(first, sight)` for each vector of places. The last one may go beyond the end.
template <class Visit>
HWY_INLINE void for_sights(const SightGrid& grid, const SightPlaces& places, Visit&& visit) {
  const Reals d;
  const std::size_t lanes = hn::Lanes(d);
  R x, y, z;
  std::size_t k = 0;
  for (; k + lanes <= places.count; k += lanes) {
    hn::LoadInterleaved3(d, places.places + 3 * k, x, y, z);
    visit(k, sight_of(grid, places, x, y, z));
  }
  if (k == places.count) return;
  float rest[3 * kMostLanes] = {};
  std::copy(places.places + 3 * k, places.places + 3 * places.count, rest);
  hn::LoadInterleaved3(d, rest, x, y, z);
  visit(k, sight_of(grid, places, x, y, z));
}

HWY_INLINE void store(const Sight& sight, std::size_t first, const Sights& sights) {
  hn::StoreU(sight.range, Reals(), sights.range + first);
  hn::StoreU(sight.column, Whole(), sights.column + first);
  hn::StoreU(sight.row, Whole(), sights.row + first);
}

void locate(const SightGrid& grid, const SightPlaces& places, const Sights& sights) {
  for_sights(grid, places,
             [&](std::size_t first, const Sight& sight) { store(sight, first, sights); });
}

/// What the bins of places say of them, and what their windows do.
struct Returns {
  R nearest, farthest;
  hn::Mask<Reals> none_below;  ///< No return in the place's row or below it.
};

HWY_INLINE Returns returns_at(const float* image, W pair) {
  const Reals d;
  const R second = hn::GatherIndex(d, image + 1, pair);
  return {hn::GatherIndex(d, image, pair), hn::Abs(second), hn::Gt(second, hn::Zero(d))};
}

/// Where the tests against one range are; metres.
struct Bounds {
  R reach, from, beyond, farther;
};

HWY_INLINE Bounds bounds_at(R range, const SightTest& test) {
  const R reach = hn::Add(real(test.agree[0]), hn::Mul(real(test.agree[1]), range));
  const R beyond =
      hn::Add(hn::Add(range, real(test.occluded[0])), hn::Mul(real(test.occluded[1]), range));
  return {reach, hn::Sub(range, reach), beyond, hn::Max(hn::Add(range, reach), beyond)};
}

/// Whether a return agrees, however the sums of ranges and reaches are rounded.
HWY_INLINE hn::Mask<Reals> agrees(R found, R range, const Bounds& bounds) {
  const auto inside = hn::And(hn::Ge(found, bounds.from), hn::Le(found, bounds.farther));
  return hn::And(inside, hn::Le(hn::Abs(hn::Sub(found, range)), bounds.reach));
}

std::size_t choose(const SightGrid& grid, const SightPlaces& places, const SightImage& image,
                   const SightTest& test, const ChosenSights& chosen) {
  const Reals d;
  const Whole whole;
  const hn::Rebind<std::uint32_t, Reals> numbers;
  std::size_t count = 0;
  for_sights(grid, places, [&](std::size_t first, const Sight& sight) {
    auto asked = hn::And(hn::Ge(sight.range, real(test.range_min)),
                         hn::Le(sight.range, real(test.range_max)));
    asked = hn::And(asked, hn::FirstN(d, std::min(places.count - first, hn::Lanes(d))));
    const auto in_rows = hn::And(hn::Gt(sight.row, hn::Set(whole, -1)),
                                 hn::Lt(sight.row, hn::Set(whole, image.rows)));
    W pair = hn::Add(hn::Mul(sight.row, hn::Set(whole, image.stride())),
                     hn::Add(sight.column, hn::Set(whole, image.margin)));
    pair = hn::IfThenElseZero(in_rows, hn::Add(pair, pair));
    const auto least =
        hn::And(hn::RebindMask(d, in_rows), hn::Gt(sight.range, real(test.least_range)));
    const Returns window = returns_at(test.windows, pair);
    const Bounds bounds = bounds_at(sight.range, test);
    const auto empty = hn::Eq(window.nearest, real(std::numeric_limits<float>::infinity()));
    const auto in_front = hn::Gt(window.nearest, bounds.farther);
    const auto says_nothing = hn::Or(hn::Or(empty, hn::And(in_front, window.none_below)),
                                     hn::Lt(window.farthest, bounds.from));
    const auto told = hn::AndNot(hn::And(least, says_nothing), asked);
    if (hn::AllFalse(d, told)) return;
    const Returns own = returns_at(test.bins, pair);
    const auto agree = hn::And(least, hn::Or(agrees(own.nearest, sight.range, bounds),
                                             agrees(own.farthest, sight.range, bounds)));
    const auto free = hn::And(least, in_front);
    const auto code = [&](Sighted sighted) {
      return hn::Set(whole, static_cast<std::int32_t>(sighted));
    };
    const W sighted =
        hn::IfThenElse(hn::RebindMask(whole, agree), code(Sighted::kAgree),
                       hn::IfThenElseZero(hn::RebindMask(whole, free), code(Sighted::kFree)));
    const auto number = hn::Iota(numbers, static_cast<std::uint32_t>(first));
    const auto told_whole = hn::RebindMask(whole, told);
    hn::CompressStore(number, hn::RebindMask(numbers, told), numbers, chosen.place + count);
    hn::CompressStore(sighted, told_whole, whole, chosen.sighted + count);
    hn::CompressStore(sight.range, told, d, chosen.sights.range + count);
    hn::CompressStore(sight.column, told_whole, whole, chosen.sights.column + count);
    count += hn::CompressStore(sight.row, told_whole, whole, chosen.sights.row + count);
  });
  return count;
}

/// What the bins that were looked at say of some places.
struct Findings {
  hn::Mask<Reals> agree, occluded, below;
};

/// Looks at the bins of one row of the windows of `asked` places.
/// @param pair the numbers of the place's column in that row
HWY_INLINE void look_at_row(const SightTest& test, R range, const Bounds& bounds, W pair,
                            bool is_below, hn::Mask<Reals> asked, Findings& found) {
  const Reals d;
  const R infinite = real(std::numeric_limits<float>::infinity());
  const auto take = [&](R nearest, hn::Mask<Reals> of) {
    found.occluded = hn::Or(found.occluded, hn::And(of, hn::Lt(nearest, bounds.beyond)));
    if (is_below) found.below = hn::Or(found.below, hn::And(of, hn::Lt(nearest, infinite)));
  };
  // Few rows have returns at about the place's range. The others say the same as their nearest.
  const R nearest = hn::GatherIndex(d, test.row_windows, pair);
  const R farthest = hn::Neg(hn::GatherIndex(d, test.row_windows + 1, pair));
  const auto aside = hn::Or(hn::Lt(farthest, bounds.from), hn::Gt(nearest, bounds.farther));
  take(nearest, hn::And(asked, aside));
  const auto look = hn::AndNot(aside, asked);
  if (hn::AllFalse(d, look)) return;
  for (int shift = -2 * test.wide; shift <= 2 * test.wide; shift += 2) {
    const R near = hn::GatherIndex(d, test.bins + shift, pair);
    const R far = hn::Neg(hn::GatherIndex(d, test.bins + shift + 1, pair));
    const auto agrees = hn::Or(hn::Le(hn::Abs(hn::Sub(near, range)), bounds.reach),
                               hn::Le(hn::Abs(hn::Sub(far, range)), bounds.reach));
    found.agree = hn::Or(found.agree, hn::And(look, agrees));
    take(near, look);
  }
}

void settle(const SightImage& image, const SightTest& test, const std::uint32_t* unsure,
            std::size_t count, const ChosenSights& chosen) {
  const Reals d;
  const Whole whole;
  const std::size_t lanes = hn::Lanes(d);
  const auto code = [&](Sighted sighted) {
    return hn::Set(whole, static_cast<std::int32_t>(sighted));
  };
  for (std::size_t first = 0; first < count; first += lanes) {
    const auto there = hn::FirstN(whole, std::min(count - first, lanes));
    const W which = hn::IfThenElseZero(
        there, hn::BitCast(whole, hn::LoadU(hn::Rebind<std::uint32_t, Reals>(), unsure + first)));
    const R range = hn::GatherIndex(d, chosen.sights.range, which);
    const W column = hn::GatherIndex(whole, chosen.sights.column, which);
    const W row = hn::GatherIndex(whole, chosen.sights.row, which);
    const auto known_window = hn::Gt(range, real(test.least_range));
    const Bounds bounds = bounds_at(range, test);
    const auto none = hn::Lt(hn::Zero(d), hn::Zero(d));
    Findings found{none, none, none};
    for (int up = -test.high; up <= test.high; ++up) {
      const W r = hn::Add(row, hn::Set(whole, up));
      const auto inside =
          hn::And(hn::Gt(r, hn::Set(whole, -1)), hn::Lt(r, hn::Set(whole, image.rows)));
      const W bin = hn::Add(hn::Mul(r, hn::Set(whole, image.stride())),
                            hn::Add(column, hn::Set(whole, image.margin)));
      const W safe = hn::IfThenElse(inside, bin, hn::Set(whole, image.margin));
      look_at_row(test, range, bounds, hn::Add(safe, safe), up <= 0,
                  hn::And(hn::RebindMask(d, inside), known_window), found);
    }
    const auto seen = hn::Lt(row, hn::Set(whole, image.first_unseen_row));
    const auto free = hn::And(hn::RebindMask(d, seen), hn::AndNot(found.occluded, found.below));
    W sighted =
        hn::IfThenElse(hn::RebindMask(whole, free), code(Sighted::kFree), code(Sighted::kNothing));
    sighted =
        hn::IfThenElse(hn::RebindMask(whole, found.occluded), code(Sighted::kOccluded), sighted);
    sighted = hn::IfThenElse(hn::RebindMask(whole, found.agree), code(Sighted::kAgree), sighted);
    sighted = hn::IfThenElse(hn::RebindMask(whole, known_window), sighted, code(Sighted::kUnsure));
    std::int32_t settled[kMostLanes];
    hn::StoreU(sighted, whole, settled);
    for (std::size_t i = 0; i < std::min(count - first, lanes); ++i) {
      chosen.sighted[unsure[first + i]] = settled[i];
    }
  }
}

/// Calls `visit(k)` with the places of vectors that cover `count` numbers; the last one may overlap
/// the one before.
template <class Visit>
HWY_INLINE void for_vectors(std::size_t count, Visit&& visit) {
  const std::size_t lanes = hn::Lanes(Reals());
  for (std::size_t k = 0; k < count; k += lanes) visit(std::min(k, count - lanes));
}

void fill_windows(const SightImage& image, int wide, int high, const float* bins,
                  float* row_windows, float* windows) {
  const Reals d;
  const auto numbers = static_cast<std::size_t>(2 * image.columns);
  const auto row_at = [&](int r) {
    return 2 * (static_cast<std::size_t>(r) * static_cast<std::size_t>(image.stride()) +
                static_cast<std::size_t>(image.margin));
  };
  for (int r = 0; r < image.rows; ++r) {
    const float* const from = bins + row_at(r);
    for_vectors(numbers, [&](std::size_t k) {
      R least = hn::LoadU(d, from + k);
      for (int shift = 2; shift <= 2 * wide; shift += 2) {
        least = hn::Min(least, hn::LoadU(d, from + k - shift));
        least = hn::Min(least, hn::LoadU(d, from + k + shift));
      }
      hn::StoreU(least, d, row_windows + row_at(r) + k);
    });
  }
  for (int r = 0; r < image.rows; ++r) {
    for_vectors(static_cast<std::size_t>(image.columns), [&](std::size_t column) {
      R nearest, second, nearest_below = real(std::numeric_limits<float>::infinity());
      R least = nearest_below, least_second = nearest_below;
      for (int other = std::max(r - high, 0); other <= std::min(r + high, image.rows - 1);
           ++other) {
        hn::LoadInterleaved2(d, row_windows + row_at(other) + 2 * column, nearest, second);
        least = hn::Min(least, nearest);
        least_second = hn::Min(least_second, second);
        if (other == r && r < image.first_unseen_row) nearest_below = least;
      }
      const auto none_below = hn::Eq(nearest_below, real(std::numeric_limits<float>::infinity()));
      second = hn::IfThenElse(none_below, hn::Abs(least_second), least_second);
      hn::StoreInterleaved2(least, second, d, windows + row_at(r) + 2 * column);
    });
  }
}

}  // namespace

SightKernels sight_kernels() {
  return {&locate, &choose, &settle, &fill_windows};
}

}  // namespace HWY_NAMESPACE
}  // namespace raymoval::raymoval_plus_method::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "core/simd/instruction_sets.h"

namespace raymoval::raymoval_plus_method::kernels {

HWY_EXPORT(sight_kernels);

SightKernels best_sight_kernels() {
  return RAYMOVAL_BEST_KERNEL(sight_kernels)();
}

}  // namespace raymoval::raymoval_plus_method::kernels
#endif
