// SPDX-License-Identifier: MIT
// What the parts of the brick-column sweep (see first_hit.h) share. Like them, included once for
// each instruction set.
#if defined(RAYMOVAL_FIRST_HIT_VECTORS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYMOVAL_FIRST_HIT_VECTORS_INL
#undef RAYMOVAL_FIRST_HIT_VECTORS_INL
#else
#define RAYMOVAL_FIRST_HIT_VECTORS_INL
#endif

#include "hwy/highway.h"
#include "methods/raymoval/kernels/first_hit_sweep.h"

HWY_BEFORE_NAMESPACE();
namespace raymoval::raymoval_method::sweep {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, kGroup>;
using Ints = hn::RebindToSigned<Floats>;
using F = hn::Vec<Floats>;

F number(double value) {
  return hn::Set(Floats(), static_cast<float>(value));
}

/// One bit a lane.
HWY_INLINE std::uint32_t mask_bits(hn::Mask<Floats> mask) {
  std::uint64_t bytes = 0;
  hn::StoreMaskBits(Floats(), mask, reinterpret_cast<std::uint8_t*>(&bytes));
  return static_cast<std::uint32_t>(bytes);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace raymoval::raymoval_method::sweep
HWY_AFTER_NAMESPACE();

#endif
