// SPDX-License-Identifier: MIT
#include "methods/dynablox/voxel_kernels.h"

#include <iterator>

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

/// The angle of (x, y) from the x axis, radians in [-pi, pi], with an error below 4e-7; 0 for (0,
/// 0). Beyond 45 degrees the polynomial is rotated and mirrored. Highway's own atan would round
/// differently where multiplication and addition are one instruction.
HWY_INLINE F angle_of(F y, F x) {
  const Floats d;
  const F across = hn::Abs(x), up = hn::Abs(y);
  const F longer = hn::Max(hn::Max(across, up), hn::Set(d, 1e-30F));  // Not 0: it divides.
  const F ratio = hn::Div(hn::Min(across, up), longer);
  const F square = hn::Mul(ratio, ratio);
  F sum = hn::Set(d, kArcTangentTerms[0]);
  for (std::size_t k = 1; k < std::size(kArcTangentTerms); ++k) {
    sum = hn::Add(hn::Mul(sum, square), hn::Set(d, kArcTangentTerms[k]));
  }
  F angle = hn::Mul(sum, ratio);
  angle = hn::IfThenElse(hn::Gt(up, across), hn::Sub(hn::Set(d, 0.5F * kHalfTurn), angle), angle);
  angle = hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Sub(hn::Set(d, kHalfTurn), angle), angle);
  return hn::CopySign(angle, y);
}

HWY_INLINE F number(float value) {
  return hn::Set(Floats(), value);
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
    const I row = hn::Add(hn::ConvertTo(ints, hn::IfThenElseZero(inside, v)), hn::Set(ints, 1));
    const I column = hn::Min(hn::ConvertTo(ints, u), hn::Set(ints, image.columns - 1));
    const I at = hn::Add(hn::Mul(row, hn::Set(ints, image.columns + 1)), column);
    const I none = hn::Set(ints, -1);
    hn::StoreU(hn::IfThenElse(hn::RebindMask(ints, inside), at, none), ints, pixel + k);
    hn::StoreU(range, d, range_of + k);
  }
}

/// Four pixels around a place in the image, and the distances of the place from the left and lower
/// pixels.
struct Pixels {
  F lower_left, lower_right, upper_left, upper_right;  ///< Ranges, 0 where there is no return.
  F right_share, upper_share;
};
HWY_INLINE Pixels pixels_around(const Integration& scan, F u, F v) {
  const Floats d;
  const Ints ints;
  const F left = hn::Floor(u), below = hn::Floor(v);
  const I column = hn::ConvertTo(ints, left);
  const I before_first = hn::Set(ints, scan.columns);
  const I wrapped =
      hn::IfThenElse(hn::Lt(column, hn::Zero(ints)), hn::Add(column, before_first), column);
  const I last = hn::Set(ints, scan.columns - 1);
  const I row = hn::Add(hn::ConvertTo(ints, below), hn::Set(ints, 1));
  const I stride = hn::Set(ints, scan.columns + 1);
  const I at = hn::Add(hn::Mul(row, stride), hn::Min(wrapped, last));
  const float* upper = scan.image + scan.columns + 1;
  return {hn::GatherIndex(d, scan.image, at),
          hn::GatherIndex(d, scan.image + 1, at),
          hn::GatherIndex(d, upper, at),
          hn::GatherIndex(d, upper + 1, at),
          hn::Sub(u, left),
          hn::Sub(v, below)};
}

/// Two values combined: the one with a return, or the mean and the nearer of both.
struct MeanAndLeast {
  F mean, least;
};
HWY_INLINE MeanAndLeast together(const MeanAndLeast& a, const MeanAndLeast& b, F share_of_b) {
  const F zero = hn::Zero(Floats());
  const auto only_b = hn::Eq(a.mean, zero), only_a = hn::Eq(b.mean, zero);
  const auto either = [&](F of_a, F of_b, F of_both) {
    return hn::IfThenElse(only_b, of_b, hn::IfThenElse(only_a, of_a, of_both));
  };
  const F share_of_a = hn::Sub(number(1.0F), share_of_b);
  const F mean = hn::Add(hn::Mul(share_of_a, a.mean), hn::Mul(share_of_b, b.mean));
  return {either(a.mean, b.mean, mean), either(a.least, b.least, hn::Min(a.least, b.least))};
}

/// The interpolated range of four pixels, first along columns, then across. If the nearest pixel is
/// nearer than that by more than half the truncation, the nearest pixel. 0 without a return.
HWY_INLINE F adaptive_range(const Pixels& pixels, float truncation) {
  const auto column = [&](F lower, F upper) {
    return together({lower, lower}, {upper, upper}, pixels.upper_share);
  };
  const MeanAndLeast both =
      together(column(pixels.lower_left, pixels.upper_left),
               column(pixels.lower_right, pixels.upper_right), pixels.right_share);
  const auto is_far = hn::Lt(hn::Add(both.least, number(0.5F * truncation)), both.mean);
  return hn::IfThenElse(is_far, both.least, both.mean);
}

/// The weight of a scan in voxels. @param square of the voxels' ranges
/// @param ahead distance of the voxels before the surface, metres
HWY_INLINE F weight_of_scan(const Integration& scan, F square, F ahead) {
  const F rays = hn::Div(number(scan.rays_at_a_metre), hn::Max(square, number(1.0F)));
  const F left_of_rays = hn::Div(hn::Mul(rays, hn::Add(number(scan.truncation), ahead)),
                                 number(scan.truncation - scan.voxel_size));
  return hn::IfThenElse(hn::Lt(ahead, number(-scan.voxel_size)), left_of_rays, rays);
}

/// Some voxels of a row with their centres.
HWY_INLINE bool integrate_some(const Integration& scan, F x, F y, F z, float* distance,
                               float* weight) {
  const Floats d;
  const F level_square = hn::Add(hn::Mul(x, x), hn::Mul(y, y));
  const F square = hn::Add(level_square, hn::Mul(z, z));
  const F range = hn::Sqrt(square);
  auto wanted =
      hn::And(hn::Ge(range, number(scan.min_range)), hn::Le(range, number(scan.max_range)));
  const F elevation = angle_of(z, hn::Sqrt(level_square));
  const F v = hn::Mul(hn::Sub(elevation, number(scan.elevation_min)), number(scan.rows_per_radian));
  wanted = hn::And(wanted, hn::And(hn::Ge(v, hn::Zero(d)), hn::Le(v, number(scan.last_row))));
  if (hn::AllFalse(d, wanted)) return false;
  const F azimuth = hn::Add(angle_of(y, x), number(kHalfTurn));
  const F u = hn::Sub(hn::Mul(azimuth, number(scan.columns_per_radian)), number(0.5F));
  // Lanes that are not wanted must not read outside the image.
  const Pixels pixels = pixels_around(scan, u, hn::IfThenElseZero(wanted, v));
  const F seen = adaptive_range(pixels, scan.truncation);
  const F ahead = hn::Sub(seen, range);
  const F truncation = number(scan.truncation);
  wanted = hn::And(wanted, hn::And(hn::Gt(seen, hn::Zero(d)), hn::Gt(ahead, hn::Neg(truncation))));
  if (hn::AllFalse(d, wanted)) return false;
  const F added = weight_of_scan(scan, square, ahead);
  const F old_distance = hn::LoadU(d, distance), old_weight = hn::LoadU(d, weight);
  const F more = hn::Add(old_weight, added);
  const F sum =
      hn::Add(hn::Mul(old_distance, old_weight), hn::Mul(hn::Min(ahead, truncation), added));
  const F new_weight = hn::Min(more, number(scan.max_weight));
  hn::StoreU(hn::IfThenElse(wanted, hn::Div(sum, more), old_distance), d, distance);
  hn::StoreU(hn::IfThenElse(wanted, new_weight, old_weight), d, weight);
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
  const F weight = hn::LoadU(Floats(), layer.weight + at);
  const auto is_seen = hn::RebindMask(ints, hn::Gt(weight, number(kSeenWeight)));
  const auto is_free = hn::Lt(last_occupied, hn::Set(ints, scan.scan - scan.burn_in + 1));
  return bits_of(hn::And(is_free, is_seen));
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
      const auto is_long = hn::Gt(new_scans, hn::Set(ints, scan.frames_to_reset - 1));
      lasting |= bits_of(hn::And(is_occupied, is_long)) << x;
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
