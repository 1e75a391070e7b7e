// SPDX-License-Identifier: MIT
#include "methods/hmm_mos/distances.h"

#include <bit>

#include "core/simd/compiled_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/hmm_mos/nearness_kernel.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
//
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace raymoval::hmm_mos_method::kernels {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Bytes = hn::CappedTag<std::uint8_t, 64>;

void take_nearest(const NearRows& rows, std::size_t first, std::size_t last,
                  std::uint8_t* nearest) {
  const Bytes d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t at = first / lanes * lanes; at <= last; at += lanes) {
    auto most = hn::LoadU(d, nearest + at);
    for (std::uint64_t left = rows.which; left != 0; left &= left - 1) {
      const int row = std::countr_zero(left);
      const auto near = hn::LoadU(d, rows.rows + row * rows.stride + at);
      most = hn::Max(most, hn::SaturatedSub(near, hn::Set(d, rows.away[row])));
    }
    hn::StoreU(most, d, nearest + at);
  }
}

}  // namespace

TakeNearest take_nearest_kernel() {
  return &take_nearest;
}

}  // namespace HWY_NAMESPACE
}  // namespace raymoval::hmm_mos_method::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "core/simd/instruction_sets.h"

namespace raymoval::hmm_mos_method::kernels {

HWY_EXPORT(take_nearest_kernel);

TakeNearest best_take_nearest() {
  return RAYMOVAL_BEST_KERNEL(take_nearest_kernel)();
}

}  // namespace raymoval::hmm_mos_method::kernels
#endif
