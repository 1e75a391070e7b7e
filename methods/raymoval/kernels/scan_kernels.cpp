// SPDX-License-Identifier: MIT
#include "methods/raymoval/kernels/scan_kernels.h"

#include <array>

#include "core/simd/compiled_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/raymoval/kernels/scan_kernels.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
//
#include "hwy/contrib/math/math-inl.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace raymoval::raymoval_method::kernels {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, 8>;
using HalfFloats = hn::Rebind<float, Doubles>;
using HalfInts = hn::Rebind<std::int32_t, Doubles>;
using D = hn::Vec<Doubles>;
using Floats = hn::CappedTag<float, 16>;
using F = hn::Vec<Floats>;

HWY_INLINE D number(double value) {
  return hn::Set(Doubles(), value);
}

struct Points {
  D x, y, z;
};

HWY_INLINE Points load_points(const float* points) {
  const HalfFloats narrow;
  const Doubles d;
  hn::Vec<HalfFloats> x, y, z;
  hn::LoadInterleaved3(narrow, points, x, y, z);
  return {hn::PromoteTo(d, x), hn::PromoteTo(d, y), hn::PromoteTo(d, z)};
}

HWY_INLINE F float_number(double value) {
  return hn::Set(Floats(), static_cast<float>(value));
}

HWY_INLINE F atan2_of(F y, F x) {
  const Floats d;
  const F angle = hn::Atan(d, hn::Div(hn::Abs(y), hn::Abs(x)));
  const F turned = hn::Sub(float_number(3.14159265358979323846), angle);
  return hn::CopySign(hn::IfThenElse(hn::Lt(x, hn::Zero(d)), turned, angle), y);
}

/// The bin of an angle, found in single precision, and whether it may be wrong.
struct Bin {
  F number;
  hn::Mask<Floats> close_call;
};
HWY_INLINE Bin bin_at(F angle, double bins_per_radian, int bins) {
  const Floats d;
  // Each of the roundings on the way is below 4e-7 of the largest angle, and there are about five.
  constexpr double kRoundings = 4e-6, kRounding = 2.4e-7;
  const F tolerance = float_number(kRoundings * bins_per_radian + kRounding * bins);
  const F coordinate = hn::Mul(angle, float_number(bins_per_radian));
  const F bin = hn::Floor(coordinate);
  const F part = hn::Sub(coordinate, bin);
  const F last = hn::Sub(hn::Set(d, 1.0F), tolerance);
  // NaN is a close call, too.
  return {bin, hn::Not(hn::And(hn::Gt(part, tolerance), hn::Lt(part, last)))};
}

/// The ranges of some points, computed in double and rounded once, and the excess of each over the
/// minimum range.
HWY_INLINE void find_ranges(const Projection& job, const float* x, const float* y, const float* z,
                            std::size_t lanes, float* range, float* margin) {
  const Doubles d;
  const HalfFloats narrow;
  for (std::size_t i = 0; i < lanes; i += hn::Lanes(d)) {
    const D a = hn::PromoteTo(d, hn::Load(narrow, x + i));
    const D b = hn::PromoteTo(d, hn::Load(narrow, y + i));
    const D c = hn::PromoteTo(d, hn::Load(narrow, z + i));
    const D exact = hn::Sqrt(hn::Add(hn::Mul(a, a), hn::Add(hn::Mul(b, b), hn::Mul(c, c))));
    hn::StoreU(hn::DemoteTo(narrow, exact), narrow, range + i);
    hn::Store(hn::DemoteTo(narrow, hn::Sub(exact, number(job.minimum_range))), narrow, margin + i);
  }
}

bool project(const Projection& job, std::size_t begin, std::size_t end) {
  const Floats d;
  bool any_close = false;
  const hn::RebindToSigned<Floats> ints;
  const std::size_t lanes = hn::Lanes(d);
  alignas(64) std::array<float, 16> px, py, pz, margins;
  for (std::size_t k = begin; k < end; k += lanes) {
    F x, y, z;
    hn::LoadInterleaved3(d, job.points + 3 * k, x, y, z);
    hn::Store(x, d, px.data());
    hn::Store(y, d, py.data());
    hn::Store(z, d, pz.data());
    find_ranges(job, px.data(), py.data(), pz.data(), lanes, job.range + k, margins.data());
    const F level = hn::Sqrt(hn::Add(hn::Mul(x, x), hn::Mul(y, y)));
    const F azimuth = hn::Add(atan2_of(y, x), float_number(3.14159265358979323846));
    const F elevation = hn::Sub(hn::Atan(d, hn::Div(z, level)), float_number(job.elevation_min));
    const Bin i = bin_at(azimuth, job.azimuth_bins_per_radian, job.azimuth_bins);
    const Bin j = bin_at(elevation, job.elevation_bins_per_radian, job.elevation_bins);
    const F margin = hn::Load(d, margins.data());
    const auto close =
        hn::Or(hn::Or(i.close_call, j.close_call), hn::Lt(hn::Abs(margin), float_number(1e-7)));
    const auto inside = hn::And(
        hn::Ge(margin, hn::Zero(d)),
        hn::And(hn::Ge(j.number, hn::Zero(d)), hn::Lt(j.number, float_number(job.elevation_bins))));
    const auto bin =
        hn::Add(hn::Mul(hn::ConvertTo(ints, j.number), hn::Set(ints, job.azimuth_bins)),
                hn::ConvertTo(ints, i.number));
    const auto known = hn::IfThenElse(hn::RebindMask(ints, inside), bin, hn::Set(ints, kNoBin));
    const auto answer =
        hn::IfThenElse(hn::RebindMask(ints, close), hn::Set(ints, kCloseCall), known);
    hn::StoreU(answer, ints, job.bin + k);
    any_close = any_close || !hn::AllFalse(d, close);
  }
  return any_close;
}

bool voxelise(const Voxelisation& job, std::size_t begin, std::size_t end) {
  const Doubles d;
  auto inside = hn::Eq(hn::Zero(d), hn::Zero(d));
  for (std::size_t k = begin; k < end; k += hn::Lanes(d)) {
    const Points p = load_points(job.points + 3 * k);
    std::array<hn::Vec<HalfInts>, 3> cells;
    for (std::size_t row = 0; row < 3; ++row) {
      const D x = hn::Mul(number(job.rotation[3 * row]), p.x);
      const D y = hn::Mul(number(job.rotation[3 * row + 1]), p.y);
      const D z = hn::Mul(number(job.rotation[3 * row + 2]), p.z);
      const D world = hn::Add(hn::Add(hn::Add(x, y), z), number(job.translation[row]));
      const D cell = hn::Floor(hn::Mul(world, number(job.inverse_voxel_size)));
      inside = hn::And(inside, hn::Le(hn::Abs(cell), number(job.limit)));
      cells[row] = hn::DemoteTo(HalfInts(), cell);
    }
    hn::StoreInterleaved3(cells[0], cells[1], cells[2], HalfInts(), job.voxels + 3 * k);
  }
  return hn::AllTrue(d, inside);
}

}  // namespace

ScanKernels scan_kernels() {
  return {hn::Lanes(Floats()), &project, &voxelise};
}

}  // namespace HWY_NAMESPACE
}  // namespace raymoval::raymoval_method::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "core/simd/instruction_sets.h"

namespace raymoval::raymoval_method::kernels {

HWY_EXPORT(scan_kernels);

ScanKernels best_scan_kernels() {
  return RAYMOVAL_BEST_KERNEL(scan_kernels)();
}

}  // namespace raymoval::raymoval_method::kernels
#endif
