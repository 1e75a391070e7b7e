// SPDX-License-Identifier: MIT
#include "methods/raymoval/kernels/scan_kernels.h"

#include <algorithm>
#include <array>
#include <limits>

#include "core/simd/compiled_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/raymoval/kernels/scan_kernels.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
//
#include "hwy/cache_control.h"
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

/// The bin that an angle lies in, found in single precision, and whether that may be the wrong one.
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
  // What is not a number is a close call, too.
  return {bin, hn::Not(hn::And(hn::Gt(part, tolerance), hn::Lt(part, last)))};
}

/// The ranges of some points, found in double and rounded once, and by how much each is beyond the
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
    for (std::size_t row = 0; row < 3; ++row) {
      const D x = hn::Mul(number(job.rotation[3 * row]), p.x);
      const D y = hn::Mul(number(job.rotation[3 * row + 1]), p.y);
      const D z = hn::Mul(number(job.rotation[3 * row + 2]), p.z);
      const D world = hn::Add(hn::Add(hn::Add(x, y), z), number(job.translation[row]));
      const D cell = hn::Floor(hn::Mul(world, number(job.inverse_voxel_size)));
      inside = hn::And(inside, hn::Le(hn::Abs(cell), number(job.limit)));
      hn::StoreU(hn::DemoteTo(HalfInts(), cell), HalfInts(), job.voxels[row] + k);
    }
  }
  return hn::AllTrue(d, inside);
}

std::size_t find_runs(const RunSearch& job) {
  const hn::RebindToSigned<Floats> d;
  const hn::RebindToUnsigned<Floats> numbers;
  std::size_t runs = 0;
  for (std::size_t k = 0; k < job.count; k += hn::Lanes(d)) {
    std::array<hn::Vec<decltype(d)>, 3> here;
    auto differs = hn::Zero(d);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      here[axis] = hn::LoadU(d, job.voxels[axis] + k + 1);
      differs = hn::Or(differs, hn::Xor(here[axis], hn::LoadU(d, job.voxels[axis] + k)));
    }
    const auto begins = hn::Ne(differs, hn::Zero(d));
    hn::StoreInterleaved3(hn::Compress(here[0], begins), hn::Compress(here[1], begins),
                          hn::Compress(here[2], begins), d, job.run_voxels + 3 * runs);
    const auto number = hn::Iota(numbers, job.first_point + static_cast<std::uint32_t>(k));
    hn::StoreU(hn::Compress(number, hn::RebindMask(numbers, begins)), numbers,
               job.run_first + runs);
    runs += hn::CountTrue(d, begins);
  }
  return runs;
}

/// Eq. 11 for a few points: the difference in float, the margin in double, as `check_consistency`
/// says.
HWY_NOINLINE void check_exactly(const ConsistencyCheck& job, std::size_t begin, std::size_t end) {
  for (std::size_t k = begin; k < end; ++k) {
    if (job.bin[k] < 0) continue;
    const float reference = job.reference[job.bin[k]], range = job.range[k];
    const bool has_reference = reference < std::numeric_limits<float>::infinity();
    const double ahead = reference - range, margin = job.tau0 + job.tau1 * double{range};
    job.dynamic[k] = has_reference && ahead > margin ? 1 : 0;
  }
}

void check(const ConsistencyCheck& job, std::size_t begin, std::size_t end) {
  const Floats d;
  const hn::RebindToSigned<Floats> ints;
  const std::size_t lanes = hn::Lanes(d);
  const F infinite = hn::Set(d, std::numeric_limits<float>::infinity());
  // In single precision first, with a margin that is a little too small: few points come near it.
  constexpr double kLess = 1.0 - 1e-5;
  constexpr std::size_t kAhead = 96;  // Points whose references are fetched beforehand.
  const F tau0 = float_number(job.tau0 * kLess), tau1 = float_number(job.tau1 * kLess);
  std::fill(job.dynamic + begin, job.dynamic + end, std::uint8_t{0});
  for (std::size_t k = begin; k < end; k += lanes) {
    const auto bin = hn::LoadU(ints, job.bin + k);
    const F range = hn::LoadU(d, job.range + k);
    if (k + kAhead < end) hwy::Prefetch(job.reference + job.bin[k + kAhead]);
    const F reference = hn::GatherIndex(d, job.reference, hn::Max(bin, hn::Zero(ints)));
    const auto in_bin = hn::RebindMask(d, hn::Gt(bin, hn::Set(ints, -1)));
    const auto ahead = hn::Gt(hn::Sub(reference, range), hn::Add(tau0, hn::Mul(tau1, range)));
    const auto has_reference = hn::And(in_bin, hn::Lt(reference, infinite));
    if (!hn::AllFalse(d, hn::And(ahead, has_reference))) check_exactly(job, k, k + lanes);
  }
}

}  // namespace

ScanKernels scan_kernels() {
  return {hn::Lanes(Floats()), &project, &voxelise, &find_runs, &check};
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
