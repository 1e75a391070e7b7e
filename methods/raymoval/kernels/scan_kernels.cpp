// SPDX-License-Identifier: MIT
#include "methods/raymoval/kernels/scan_kernels.h"

#include <algorithm>
#include <limits>
#include <utility>

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

HWY_INLINE D atan2_of(D y, D x) {
  const Doubles d;
  const D angle = hn::Atan(d, hn::Div(hn::Abs(y), hn::Abs(x)));
  const D turned = hn::Sub(number(3.14159265358979323846), angle);
  return hn::CopySign(hn::IfThenElse(hn::Lt(x, hn::Zero(d)), turned, angle), y);
}

/// Number of the bin a coordinate (in bins) lies in, and whether it is too near to its border.
struct Bin {
  D number;
  hn::Mask<Doubles> close_call;
};
HWY_INLINE Bin bin_at(D coordinate) {
  constexpr double kTolerance = 1e-7;
  const D bin = hn::Floor(coordinate);
  const D part = hn::Sub(coordinate, bin);
  return {bin, hn::Not(hn::And(hn::Gt(part, number(kTolerance)),
                               hn::Lt(part, number(1.0 - kTolerance))))};
}

void project(const Projection& job, std::size_t begin, std::size_t end) {
  const Doubles d;
  for (std::size_t k = begin; k < end; k += hn::Lanes(d)) {
    const Points p = load_points(job.points + 3 * k);
    const D level = hn::Add(hn::Mul(p.x, p.x), hn::Mul(p.y, p.y));
    const D range =
        hn::Sqrt(hn::Add(hn::Mul(p.x, p.x), hn::Add(hn::Mul(p.y, p.y), hn::Mul(p.z, p.z))));
    const D azimuth = hn::Add(atan2_of(p.y, p.x), number(3.14159265358979323846));
    const D elevation = hn::Atan(d, hn::Div(p.z, hn::Sqrt(level)));
    const Bin i = bin_at(hn::Mul(azimuth, number(job.azimuth_bins_per_radian)));
    const Bin j = bin_at(hn::Mul(hn::Sub(elevation, number(job.elevation_min)),
                                 number(job.elevation_bins_per_radian)));
    const D margin = hn::Sub(range, number(job.minimum_range));
    const auto close =
        hn::Or(hn::Or(i.close_call, j.close_call), hn::Lt(hn::Abs(margin), number(1e-7)));
    const auto inside = hn::And(
        hn::Ge(margin, hn::Zero(d)),
        hn::And(hn::Ge(j.number, hn::Zero(d)), hn::Lt(j.number, number(job.elevation_bins))));
    const D bin = hn::Add(hn::Mul(j.number, number(job.azimuth_bins)), i.number);
    const D answer =
        hn::IfThenElse(close, number(kCloseCall), hn::IfThenElse(inside, bin, number(kNoBin)));
    hn::StoreU(hn::DemoteTo(HalfFloats(), range), HalfFloats(), job.range + k);
    hn::StoreU(hn::DemoteTo(HalfInts(), answer), HalfInts(), job.bin + k);
  }
}

bool voxelise(const Voxelisation& job, std::size_t begin, std::size_t end) {
  const Doubles d;
  auto inside = hn::Eq(hn::Zero(d), hn::Zero(d));
  for (std::size_t k = begin; k < end; k += hn::Lanes(d)) {
    const Points p = load_points(job.points + 3 * k);
    std::array<D, 3> cell;
    for (std::size_t row = 0; row < 3; ++row) {
      const D x = hn::Mul(number(job.rotation[3 * row]), p.x);
      const D y = hn::Mul(number(job.rotation[3 * row + 1]), p.y);
      const D z = hn::Mul(number(job.rotation[3 * row + 2]), p.z);
      const D world = hn::Add(hn::Add(hn::Add(x, y), z), number(job.translation[row]));
      cell[row] = hn::Floor(hn::Mul(world, number(job.inverse_voxel_size)));
      inside = hn::And(inside, hn::Le(hn::Abs(cell[row]), number(job.limit)));
    }
    hn::StoreInterleaved3(hn::DemoteTo(HalfInts(), cell[0]), hn::DemoteTo(HalfInts(), cell[1]),
                          hn::DemoteTo(HalfInts(), cell[2]), HalfInts(), job.voxels + 3 * k);
  }
  return hn::AllTrue(d, inside);
}

void check(const ConsistencyCheck& job, std::size_t begin, std::size_t end) {
  const Doubles d;
  const HalfFloats floats;
  const HalfInts ints;
  const hn::Rebind<std::uint8_t, HalfInts> bytes;
  const auto infinite = hn::Set(floats, std::numeric_limits<float>::infinity());
  for (std::size_t k = begin; k < end; k += hn::Lanes(d)) {
    const auto bin = hn::LoadU(ints, job.bin + k);
    const auto range = hn::LoadU(floats, job.range + k);
    const auto reference = hn::GatherIndex(floats, job.reference, hn::Max(bin, hn::Zero(ints)));
    const auto in_bin = hn::RebindMask(floats, hn::Gt(bin, hn::Set(ints, -1)));
    const auto has_reference = hn::And(in_bin, hn::Lt(reference, infinite));
    // The difference in float, the margin in double, as `check_consistency` says.
    const D ahead = hn::PromoteTo(d, hn::Sub(reference, range));
    const D margin = hn::Add(number(job.tau0), hn::Mul(number(job.tau1), hn::PromoteTo(d, range)));
    const auto before = hn::IfThenElseZero(hn::Gt(ahead, margin), number(1.0));
    const auto dynamic =
        hn::IfThenElseZero(hn::RebindMask(ints, has_reference), hn::DemoteTo(ints, before));
    hn::StoreU(hn::DemoteTo(bytes, dynamic), bytes, job.dynamic + k);
  }
}

HWY_INLINE void order(F& a, F& b) {
  const F low = hn::Min(a, b);
  b = hn::Max(a, b);
  a = low;
}

/// Sorts the three rows of each column into `scratch`, with one column more at either end.
void sort_columns(const WindowRow& job) {
  const Floats d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const int stride = job.columns + 2;
  for (int next = 0; next < job.columns; next += lanes) {
    const int i = std::min(next, job.columns - lanes);
    F a = hn::LoadU(d, job.values[0] + i);
    F b = hn::LoadU(d, job.values[1] + i);
    F c = hn::LoadU(d, job.values[2] + i);
    order(a, b);
    order(b, c);
    order(a, b);
    hn::StoreU(a, d, job.scratch + i + 1);
    hn::StoreU(b, d, job.scratch + stride + i + 1);
    hn::StoreU(c, d, job.scratch + 2 * stride + i + 1);
  }
  for (int k = 0; k < 3; ++k) {
    float* line = job.scratch + k * stride;
    line[0] = line[job.columns];
    line[job.columns + 1] = line[1];
  }
}

/// Sorts nine values of which three times three are sorted (the rest of Floyd's network).
HWY_INLINE void sort_nine(std::array<F, 9>& v) {
  for (std::size_t k = 0; k < 3; ++k) {
    order(v[k], v[k + 3]);
    order(v[k + 3], v[k + 6]);
    order(v[k], v[k + 3]);
  }
  constexpr std::array<std::pair<std::size_t, std::size_t>, 7> kRest = {
      {{1, 3}, {5, 7}, {2, 6}, {4, 6}, {2, 4}, {2, 3}, {5, 6}}};
  for (const auto& [a, b] : kRest) order(v[a], v[b]);
}

void percentiles(const WindowRow& job) {
  const Floats d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const F infinite = hn::Set(d, std::numeric_limits<float>::infinity());
  bool sorted = false;
  for (int next = 0; next < job.columns; next += lanes) {
    const int i = std::min(next, job.columns - lanes);
    if (hn::AllFalse(d, hn::Lt(hn::LoadU(d, job.wanted + i), infinite))) continue;
    if (!sorted) sort_columns(job);
    sorted = true;
    std::array<F, 9> v;
    for (int k = 0; k < 9; ++k) {
      v[static_cast<std::size_t>(k)] =
          hn::LoadU(d, job.scratch + k % 3 * (job.columns + 2) + i + k / 3);
    }
    sort_nine(v);
    for (std::size_t q = 0; q < 2; ++q) {
      const auto& ranks = job.ranks[q];
      const auto value_of = [&](std::size_t count) {
        return v[static_cast<std::size_t>(ranks[count])];
      };
      // The infinite ones come last: as many values are finite as the last finite one says.
      F result = value_of(1);
      for (std::size_t count = 2; count <= 9; ++count) {
        result = hn::IfThenElse(hn::Lt(v[count - 1], infinite), value_of(count), result);
      }
      hn::StoreU(result, d, job.results[q] + i);
    }
  }
}

/// Smallest of the values at columns i - radius .. i + radius of a row, lane by lane.
F minimum_along_row(const WindowMinimum& job, const float* row, int i) {
  const Floats d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  F smallest = hn::LoadU(d, row + i);
  for (int offset = 1; offset <= job.azimuth_radius; ++offset) {
    for (const int at : {i - offset, i + offset}) {
      if (at >= 0 && at + lanes <= job.columns) {
        smallest = hn::Min(smallest, hn::LoadU(d, row + at));
        continue;
      }
      alignas(64) float wrapped[16];  // The circle closes here.
      for (int lane = 0; lane < lanes; ++lane) {
        wrapped[lane] = row[(at + lane + job.columns) % job.columns];
      }
      smallest = hn::Min(smallest, hn::Load(d, wrapped));
    }
  }
  return smallest;
}

void minimum(const WindowMinimum& job, int first, int skip) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  const auto rows = static_cast<std::size_t>(job.rows);
  const auto reach = static_cast<std::size_t>(job.elevation_radius);
  const F infinite = hn::Set(d, std::numeric_limits<float>::infinity());
  for (std::size_t j = 0; j < rows + 2 * reach; ++j) {
    const bool is_row = j >= reach && j < reach + rows;
    const float* row =
        job.values + (is_row ? j - reach : 0) * static_cast<std::size_t>(job.columns);
    hn::Store(is_row ? minimum_along_row(job, row, first) : infinite, d, job.scratch + j * lanes);
  }
  // Minima over 2, 4, 8 ... rows, in place, as long as the window holds them.
  const std::size_t window = 2 * reach + 1;
  std::size_t span = 1;
  for (; 2 * span <= window; span *= 2) {
    for (std::size_t j = 0; j + 2 * span <= rows + 2 * reach; ++j) {
      float* here = job.scratch + j * lanes;
      hn::Store(hn::Min(hn::Load(d, here), hn::Load(d, here + span * lanes)), d, here);
    }
  }
  for (std::size_t j = 0; j < rows; ++j) {
    const float* here = job.scratch + j * lanes;
    const F smallest = hn::Min(hn::Load(d, here), hn::Load(d, here + (window - span) * lanes));
    float* out = job.result + j * static_cast<std::size_t>(job.columns) + first;
    if (skip == 0) {
      hn::StoreU(smallest, d, out);
    } else {
      alignas(64) float values[16];
      hn::Store(smallest, d, values);
      std::copy(values + skip, values + lanes, out + skip);
    }
  }
}

std::uint32_t suspects(const SuspectSearch& job, std::size_t bin) {
  const Floats d;
  const F infinite = hn::Set(d, std::numeric_limits<float>::infinity());
  const F tau0 = hn::Set(d, job.tau0), tau1 = hn::Set(d, job.tau1);
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 16; i += hn::Lanes(d)) {
    const F own = hn::LoadU(d, job.own + bin + i);
    const F nearest = hn::LoadU(d, job.nearest + bin + i);
    const F hit = hn::LoadU(d, job.first_hit + bin + i);
    const F reference = hn::LoadU(d, job.reference + bin + i);
    const F beyond = hn::Sub(nearest, hn::Add(reference, hn::Mul(tau1, reference)));
    const auto seen = hn::And(hn::Lt(own, infinite), hn::Lt(hit, infinite));
    const auto far = hn::And(hn::Gt(hn::Sub(nearest, hit), tau0), hn::Gt(beyond, tau0));
    std::uint64_t bytes = 0;
    hn::StoreMaskBits(d, hn::And(seen, far), reinterpret_cast<std::uint8_t*>(&bytes));
    bits |= static_cast<std::uint32_t>(bytes) << i;
  }
  return bits;
}

}  // namespace

Kernels kernels() {
  return {hn::Lanes(Doubles()),
          static_cast<int>(hn::Lanes(Floats())),
          &project,
          &voxelise,
          &check,
          &percentiles,
          &minimum,
          &suspects};
}

}  // namespace HWY_NAMESPACE
}  // namespace raymoval::raymoval_method::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "core/simd/instruction_sets.h"

namespace raymoval::raymoval_method::kernels {

HWY_EXPORT(kernels);

Kernels best_kernels() {
  return RAYMOVAL_BEST_KERNEL(kernels)();
}

}  // namespace raymoval::raymoval_method::kernels
#endif
