// SPDX-License-Identifier: MIT
#include "methods/dynablox/voxel_kernels.h"

#include "core/simd/compiled_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/dynablox/voxel_kernels.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
//
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace raymoval::dynablox_method::kernels {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kRow = 16;  ///< Voxels of a row, and rows of a layer.

using Floats = hn::CappedTag<float, kRow>;
using Ints = hn::RebindToSigned<Floats>;
using Shorts = hn::Rebind<std::uint16_t, Floats>;
using F = hn::Vec<Floats>;
using I = hn::Vec<Ints>;

HWY_INLINE F number(float value) {
  return hn::Set(Floats(), value);
}

/// atan2(y, x) to 2e-6.
HWY_INLINE F angle_of(F y, F x) {
  const Floats d;
  const F across = hn::Abs(x), up = hn::Abs(y);
  const F a = hn::Div(hn::Min(across, up), hn::Max(hn::Max(across, up), number(kLeastDivisor)));
  const F square = hn::Mul(a, a);
  F sum = number(kArcTangent[6]);
  for (std::size_t k = 6; k-- > 0;) sum = hn::Add(hn::Mul(sum, square), number(kArcTangent[k]));
  F angle = hn::Mul(sum, a);
  angle = hn::IfThenElse(hn::Gt(up, across), hn::Sub(number(kQuarterTurn), angle), angle);
  angle = hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Sub(number(kHalfTurn), angle), angle);
  return hn::CopySign(angle, y);
}

void project(const Projection& image, const float* points, std::size_t count, std::int32_t* pixel,
             float* range_of) {
  const Floats d;
  const Ints ints;
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    F x, y, z;
    hn::LoadInterleaved3(d, points + 3 * k, x, y, z);
    const F level_square = hn::Add(hn::Mul(x, x), hn::Mul(y, y));
    const F range = hn::Sqrt(hn::Add(level_square, hn::Mul(z, z)));
    const F turned = hn::Add(angle_of(y, x), number(kHalfTurn));
    const F raised = hn::Sub(angle_of(z, hn::Sqrt(level_square)), number(image.elevation_min));
    const F u = hn::Mul(turned, number(image.columns_per_radian));
    const F v = hn::Floor(hn::Add(hn::Mul(raised, number(image.rows_per_radian)), number(0.5F)));
    auto inside =
        hn::And(hn::Ge(v, hn::Zero(d)), hn::Lt(v, number(static_cast<float>(image.rows))));
    inside = hn::And(inside,
                     hn::And(hn::Ge(range, number(image.min_range)), hn::Gt(range, hn::Zero(d))));
    inside = hn::And(inside, hn::Le(range, number(image.max_range)));
    const I row = hn::Add(hn::ConvertTo(ints, hn::IfThenElseZero(inside, v)), hn::Set(ints, 1));
    const I column = hn::Min(hn::ConvertTo(ints, u), hn::Set(ints, image.columns - 1));
    const I at = hn::Add(hn::Mul(row, hn::Set(ints, image.columns + 1)), column);
    const I none = hn::Set(ints, -1);
    hn::StoreU(hn::IfThenElse(hn::RebindMask(ints, inside), at, none), ints, pixel + k);
    hn::StoreU(range, d, range_of + k);
  }
}

/// The range between four pixels: their mean, weighed by how near they are, without those that have
/// no return.
struct Between {
  F range;
  F weight;  ///< 0 where no pixel has a return.
};
HWY_INLINE Between between_pixels(const Integration& scan, F u, F v) {
  const Floats d;
  const Ints ints;
  const F left = hn::Floor(u), below = hn::Floor(v);
  const F right_share = hn::Sub(u, left), above_share = hn::Sub(v, below);
  const I column = hn::ConvertTo(ints, left);
  const I before_first = hn::Set(ints, scan.columns);
  const I wrapped =
      hn::IfThenElse(hn::Lt(column, hn::Zero(ints)), hn::Add(column, before_first), column);
  const I last = hn::Set(ints, scan.columns - 1);
  const I row = hn::Add(hn::ConvertTo(ints, below), hn::Set(ints, 1));
  const I stride = hn::Set(ints, scan.columns + 1);
  const I at = hn::Add(hn::Mul(row, stride), hn::Min(wrapped, last));
  const F one = number(1.0F);
  F sum = hn::Zero(d), weight = hn::Zero(d);
  const auto add = [&](const float* pixels, F share_across, F share_up) {
    const F range = hn::GatherIndex(d, pixels, at);
    const F share = hn::IfThenElseZero(hn::Gt(range, hn::Zero(d)), hn::Mul(share_across, share_up));
    sum = hn::Add(sum, hn::Mul(share, range));
    weight = hn::Add(weight, share);
  };
  const float* upper = scan.image + scan.columns + 1;
  const F left_share = hn::Sub(one, right_share), below_share = hn::Sub(one, above_share);
  add(scan.image, left_share, below_share);
  add(scan.image + 1, right_share, below_share);
  add(upper, left_share, above_share);
  add(upper + 1, right_share, above_share);
  return {hn::Div(sum, hn::Max(weight, number(kLeastDivisor))), weight};
}

/// Some voxels of a row with their centres.
HWY_INLINE bool integrate_some(const Integration& scan, F x, F y, F z, float* distance,
                               std::uint16_t* weight) {
  const Floats d;
  const Ints ints;
  const Shorts shorts;
  const F level_square = hn::Add(hn::Mul(x, x), hn::Mul(y, y));
  const F range = hn::Sqrt(hn::Add(level_square, hn::Mul(z, z)));
  auto wanted =
      hn::And(hn::Ge(range, number(scan.min_range)), hn::Le(range, number(scan.max_range)));
  const F elevation = angle_of(z, hn::Sqrt(level_square));
  const F v = hn::Mul(hn::Sub(elevation, number(scan.elevation_min)), number(scan.rows_per_radian));
  const F last_row = number(static_cast<float>(scan.rows) - 0.5F);
  wanted = hn::And(wanted, hn::And(hn::Ge(v, number(-0.5F)), hn::Lt(v, last_row)));
  if (hn::AllFalse(d, wanted)) return false;
  const F azimuth = hn::Add(angle_of(y, x), number(kHalfTurn));
  const F u = hn::Sub(hn::Mul(azimuth, number(scan.columns_per_radian)), number(0.5F));
  // What is not wanted must not reach beyond the image.
  const Between seen = between_pixels(scan, u, hn::IfThenElseZero(wanted, v));
  const F ahead = hn::Sub(seen.range, range);
  const F truncation = number(scan.truncation);
  wanted = hn::And(wanted,
                   hn::And(hn::Gt(seen.weight, hn::Zero(d)), hn::Gt(ahead, hn::Neg(truncation))));
  if (hn::AllFalse(d, wanted)) return false;
  const F cut = hn::Min(ahead, truncation);
  const F old_distance = hn::LoadU(d, distance);
  const F old_weight = hn::ConvertTo(d, hn::PromoteTo(ints, hn::LoadU(shorts, weight)));
  const F more = hn::Add(old_weight, number(1.0F));
  const F mean = hn::Div(hn::Add(hn::Mul(old_distance, old_weight), cut), more);
  const F kept_weight = hn::IfThenElse(wanted, hn::Min(more, number(scan.max_weight)), old_weight);
  hn::StoreU(hn::IfThenElse(wanted, mean, old_distance), d, distance);
  hn::StoreU(hn::DemoteTo(shorts, hn::ConvertTo(ints, kept_weight)), shorts, weight);
  return true;
}

bool integrate(const Integration& scan, const LayerFields& layer) {
  const Floats d;
  bool any = false;
  for (std::size_t y = 0; y < kRow; ++y) {
    std::array<F, 3> row_first, step;
    for (std::size_t k = 0; k < 3; ++k) {
      row_first[k] = number(layer.first[k] + static_cast<float>(y) * scan.along_y[k]);
      step[k] = number(scan.along_x[k]);
    }
    for (std::size_t x = 0; x < kRow; x += hn::Lanes(d)) {
      const F steps = hn::Iota(d, static_cast<float>(x));
      const std::size_t at = y * kRow + x;
      any |= integrate_some(scan, hn::Add(row_first[0], hn::Mul(steps, step[0])),
                            hn::Add(row_first[1], hn::Mul(steps, step[1])),
                            hn::Add(row_first[2], hn::Mul(steps, step[2])), layer.distance + at,
                            layer.weight + at);
    }
  }
  return any;
}

/// The lanes of a mask as the lowest bits of a word, and back.
HWY_INLINE std::uint32_t bits_of(hn::Mask<Ints> mask) {
  std::uint64_t bytes = 0;
  hn::StoreMaskBits(Ints(), mask, reinterpret_cast<std::uint8_t*>(&bytes));
  return static_cast<std::uint32_t>(bytes);
}
HWY_INLINE hn::Mask<Ints> mask_of(std::uint32_t bits) {
  const std::uint64_t bytes = bits & ((std::uint32_t{1} << hn::Lanes(Ints())) - 1);
  return hn::LoadMaskBits(Ints(), reinterpret_cast<const std::uint8_t*>(&bytes));
}

HWY_INLINE std::uint32_t settled_bits(const Sweep& scan, const SweptLayer& layer, std::size_t at,
                                      I last_occupied) {
  const Ints ints;
  const I weight = hn::PromoteTo(ints, hn::LoadU(Shorts(), layer.weight + at));
  const auto is_free = hn::Lt(last_occupied, hn::Set(ints, scan.scan - scan.burn_in + 1));
  return bits_of(hn::And(is_free, hn::Gt(weight, hn::Zero(ints))));
}

void sweep(const Sweep& scan, const SweptLayer& layer) {
  const Floats d;
  const Ints ints;
  const Shorts shorts;
  const I now = hn::Set(ints, scan.scan), one = hn::Set(ints, 1);
  const I before_break = hn::Set(ints, scan.scan - scan.temporal_buffer - 1);
  for (std::size_t y = 0; y < kRow; ++y) {
    std::uint32_t settled = 0, lasting = 0;
    const std::uint32_t hit = layer.hit == nullptr ? 0 : layer.hit[y];
    for (std::size_t x = 0; x < kRow; x += hn::Lanes(d)) {
      const std::size_t at = y * kRow + x;
      const auto is_near = hn::Lt(hn::LoadU(d, layer.distance + at), number(scan.occupied_below));
      const auto is_occupied = hn::Or(hn::RebindMask(ints, is_near), mask_of(hit >> x));
      const I last = hn::LoadU(ints, layer.last_occupied + at);
      const I scans = hn::PromoteTo(ints, hn::LoadU(shorts, layer.occupied_scans + at));
      const I more = hn::Min(hn::Add(scans, one), hn::Set(ints, 65535));
      const I counted = hn::IfThenElse(hn::Gt(last, before_break), more, one);
      const I new_scans = hn::IfThenElse(is_occupied, counted, scans);
      const I new_last = hn::IfThenElse(is_occupied, now, last);
      hn::StoreU(new_last, ints, layer.last_occupied + at);
      hn::StoreU(hn::DemoteTo(shorts, new_scans), shorts, layer.occupied_scans + at);
      const auto is_lasting =
          hn::And(is_occupied, hn::Gt(new_scans, hn::Set(ints, scan.frames_to_reset - 1)));
      lasting |= bits_of(is_lasting) << x;
      settled |= settled_bits(scan, layer, at, new_last) << x;
    }
    layer.settled[y] = static_cast<std::uint16_t>(settled);
    layer.lasting[y] = static_cast<std::uint16_t>(lasting);
  }
}

void settle(const Sweep& scan, const SweptLayer& layer) {
  const Ints ints;
  for (std::size_t y = 0; y < kRow; ++y) {
    std::uint32_t settled = 0;
    for (std::size_t x = 0; x < kRow; x += hn::Lanes(ints)) {
      const std::size_t at = y * kRow + x;
      settled |= settled_bits(scan, layer, at, hn::LoadU(ints, layer.last_occupied + at)) << x;
    }
    layer.settled[y] = static_cast<std::uint16_t>(settled);
  }
}

}  // namespace

Kernels kernels() {
  return {hn::Lanes(Floats()), &project, &integrate, &sweep, &settle};
}

}  // namespace HWY_NAMESPACE
}  // namespace raymoval::dynablox_method::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "core/simd/instruction_sets.h"

namespace raymoval::dynablox_method::kernels {

HWY_EXPORT(kernels);

Kernels best_kernels() {
  return RAYMOVAL_BEST_KERNEL(kernels)();
}

}  // namespace raymoval::dynablox_method::kernels
#endif
