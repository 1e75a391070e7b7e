// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/common/point_kernels.h"

#include <algorithm>

#include "core/simd/compiled_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/raymoval_plus/common/point_kernels.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
//
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace raymoval::raymoval_plus_method::kernels {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, 8>;
using NarrowReals = hn::Rebind<float, Doubles>;
using NarrowInts = hn::Rebind<std::int32_t, Doubles>;
using D = hn::Vec<Doubles>;
constexpr std::size_t kMostPoints = 8;  ///< That a vector of any set has.

HWY_INLINE D number(double value) {
  return hn::Set(Doubles(), value);
}

/// The part of the cell's edge below each point, in 256ths.
HWY_INLINE hn::Vec<NarrowInts> parts_of(D in_cells, D cell) {
  const D parts = hn::Mul(hn::Sub(in_cells, cell), number(256.0));
  return hn::DemoteTo(NarrowInts(), hn::Min(hn::Max(parts, number(0.0)), number(255.0)));
}

/// The cells of one vector of points, which begin at `points`; they go to place `k` of the arrays.
/// @return whether all of them are inside the limit
HWY_INLINE bool find_some(const PointsToCells& job, const float* points, std::size_t k,
                          const PointCells& cells) {
  const Doubles d;
  const NarrowInts ints;
  hn::Vec<NarrowReals> narrow[3];
  hn::LoadInterleaved3(NarrowReals(), points, narrow[0], narrow[1], narrow[2]);
  const D px = hn::PromoteTo(d, narrow[0]), py = hn::PromoteTo(d, narrow[1]),
          pz = hn::PromoteTo(d, narrow[2]);
  std::int32_t* const to[3] = {cells.x + k, cells.y + k, cells.z + k};
  auto inside = hn::Eq(hn::Zero(d), hn::Zero(d));
  hn::Vec<NarrowInts> packed = hn::Zero(ints);
  for (std::size_t axis = 3; axis-- > 0;) {
    const double* const turn = job.rotation.data() + 3 * axis;
    const D x = hn::Mul(number(turn[0]), px), y = hn::Mul(number(turn[1]), py);
    const D sum = hn::Add(hn::Add(x, y), hn::Mul(number(turn[2]), pz));
    const D world = hn::Add(sum, number(job.translation[axis]));
    const D in_cells = hn::Mul(world, number(job.cells_a_metre[axis]));
    const D cell = hn::Floor(in_cells);
    inside = hn::And(inside, hn::Le(hn::Abs(cell), number(job.limit)));
    hn::StoreU(hn::DemoteTo(ints, cell), ints, to[axis]);
    packed = hn::Or(hn::ShiftLeft<8>(packed), parts_of(in_cells, cell));
    if (axis == 2 && cells.height != nullptr) {
      hn::StoreU(hn::DemoteTo(NarrowReals(), world), NarrowReals(), cells.height + k);
    }
  }
  if (cells.parts != nullptr) {
    hn::StoreU(hn::BitCast(hn::Rebind<std::uint32_t, Doubles>(), packed),
               hn::Rebind<std::uint32_t, Doubles>(), cells.parts + k);
  }
  return hn::AllTrue(d, inside);
}

bool find_cells(const PointsToCells& job, const PointCells& cells) {
  const std::size_t lanes = hn::Lanes(Doubles());
  bool inside = true;
  std::size_t k = 0;
  for (; k + lanes <= job.count; k += lanes) {
    inside &= find_some(job, job.points + 3 * k, k, cells);
  }
  if (k == job.count) return inside;
  // The rest, in arrays that have room for a vector.
  float points[3 * kMostPoints] = {};
  std::copy(job.points + 3 * k, job.points + 3 * job.count, points);
  std::int32_t x[kMostPoints], y[kMostPoints], z[kMostPoints];
  std::uint32_t parts[kMostPoints];
  float height[kMostPoints];
  for (std::size_t i = job.count - k; i < lanes; ++i) std::copy_n(points, 3, points + 3 * i);
  inside &= find_some(job, points, 0, {x, y, z, parts, height});
  const std::size_t rest = job.count - k;
  std::copy_n(x, rest, cells.x + k);
  std::copy_n(y, rest, cells.y + k);
  std::copy_n(z, rest, cells.z + k);
  if (cells.parts != nullptr) std::copy_n(parts, rest, cells.parts + k);
  if (cells.height != nullptr) std::copy_n(height, rest, cells.height + k);
  return inside;
}

}  // namespace

PointKernels point_kernels() {
  return {&find_cells};
}

}  // namespace HWY_NAMESPACE
}  // namespace raymoval::raymoval_plus_method::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "core/simd/instruction_sets.h"

namespace raymoval::raymoval_plus_method::kernels {

HWY_EXPORT(point_kernels);

PointKernels best_point_kernels() {
  return RAYMOVAL_BEST_KERNEL(point_kernels)();
}

}  // namespace raymoval::raymoval_plus_method::kernels
#endif
