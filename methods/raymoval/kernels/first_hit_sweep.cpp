// SPDX-License-Identifier: MIT
#include "methods/raymoval/kernels/first_hit_sweep.h"

#include "core/simd/compiled_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/raymoval/kernels/first_hit_sweep.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "methods/raymoval/kernels/first_hit_sweep-inl.h"

#if HWY_ONCE
#include "core/simd/instruction_sets.h"

namespace raymoval::raymoval_method::sweep {

HWY_EXPORT(kernels);

Kernels best_kernels() {
  return RAYMOVAL_BEST_KERNEL(kernels)();
}

void BrickList::require(std::size_t bricks) {
  const std::size_t padded = (bricks + kGroup - 1) / kGroup * kGroup;
  for (std::size_t k = 0; k < 3; ++k) {
    low[k].require(padded);
    high[k].require(padded);
    plane[k].require(padded);
  }
  slot.require(padded);
  nearest.require(padded);
  first_column.require(padded);
  last_column.require(padded);
  first_row.require(padded);
  last_row.require(padded);
}

}  // namespace raymoval::raymoval_method::sweep
#endif
