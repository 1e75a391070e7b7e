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

/// The angle of (x, y) from the x axis, radians in [-pi, pi], with an error below 4e-7; 0 for (0,
/// 0). The terms are those of the odd polynomial with the smallest largest error from 0 to 45
/// degrees, which is turned and mirrored for other angles. Highway's own atan would round
/// differently where multiplication and addition are one instruction.
HWY_INLINE R angle_of(R y, R x) {
  constexpr float kTerms[] = {-0.00405456219F, 0.0218629390F, -0.0559123009F, 0.0964219570F,
                              -0.139086291F,   0.199465662F,  -0.333298594F,  0.999999344F};
  const R across = hn::Abs(x), up = hn::Abs(y);
  const R longer = hn::Max(hn::Max(across, up), real(1e-30F));  // Not 0: it divides.
  const R ratio = hn::Div(hn::Min(across, up), longer);
  const R square = hn::Mul(ratio, ratio);
  R sum = real(kTerms[0]);
  for (std::size_t k = 1; k < 8; ++k) sum = hn::Add(hn::Mul(sum, square), real(kTerms[k]));
  R angle = hn::Mul(sum, ratio);
  angle = hn::IfThenElse(hn::Gt(up, across), hn::Sub(real(0.5F * kStraight), angle), angle);
  angle = hn::IfThenElse(hn::Lt(x, real(0.0F)), hn::Sub(real(kStraight), angle), angle);
  return hn::CopySign(angle, y);
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

/// The lanes whose window has to be looked at: it is larger than the least one, or the nearest and
/// the farthest return of that do not say enough.
HWY_INLINE hn::Mask<Reals> needs_a_look(const Sight& sight, const SightWindows& windows) {
  const Reals d;
  const Whole whole;
  const auto in_rows = hn::And(hn::Gt(sight.row, hn::Set(whole, -1)),
                               hn::Lt(sight.row, hn::Set(whole, windows.rows)));
  const auto least =
      hn::And(hn::RebindMask(d, in_rows), hn::Gt(sight.range, real(windows.least_range)));
  W pair = hn::Add(hn::Mul(sight.row, hn::Set(whole, windows.stride)),
                   hn::Add(sight.column, hn::Set(whole, windows.margin)));
  pair = hn::IfThenElseZero(in_rows, hn::Add(pair, pair));
  const R nearest = hn::GatherIndex(d, windows.pairs, pair);
  const R farthest = hn::GatherIndex(d, windows.pairs + 1, pair);
  const R reach = hn::Add(real(windows.agree[0]), hn::Mul(real(windows.agree[1]), sight.range));
  const auto empty = hn::Eq(nearest, real(std::numeric_limits<float>::infinity()));
  const auto hidden = hn::Lt(farthest, hn::Sub(sight.range, reach));
  return hn::Not(hn::And(least, hn::Or(empty, hidden)));
}

std::size_t choose(const SightGrid& grid, const SightPlaces& places, const SightWindows& windows,
                   const Sights& sights, std::uint32_t* chosen) {
  std::size_t count = 0;
  for_sights(grid, places, [&](std::size_t first, const Sight& sight) {
    store(sight, first, sights);
    const auto asked = hn::And(hn::Ge(sight.range, real(windows.range_min)),
                               hn::Le(sight.range, real(windows.range_max)));
    std::uint64_t bits = 0;
    hn::StoreMaskBits(Reals(), hn::And(asked, needs_a_look(sight, windows)),
                      reinterpret_cast<std::uint8_t*>(&bits));
    for (; bits != 0; bits &= bits - 1) {
      const std::size_t k = first + static_cast<std::size_t>(__builtin_ctzll(bits));
      if (k < places.count) chosen[count++] = static_cast<std::uint32_t>(k);
    }
  });
  return count;
}

}  // namespace

SightKernels sight_kernels() {
  return {&locate, &choose};
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
