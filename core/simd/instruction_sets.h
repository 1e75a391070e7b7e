// SPDX-License-Identifier: MIT
// For the sources of kernels, after HWY_EXPORT: how the rest of a program gets at what was compiled
// once for each instruction set.
#pragma once

#include <cstdint>

#include "core/simd/simd.h"
#include "hwy/highway.h"

namespace raymoval {

/// Highway's bits for the vectors that `set` allows on this processor. 0 stands for none, the plain
/// version.
std::int64_t highway_targets(InstructionSet set);

}  // namespace raymoval

/// The version of a kernel, made known by HWY_EXPORT, for `set`.
#define RAYMOVAL_KERNEL_FOR(KERNEL, SET)                    \
  ([](::raymoval::InstructionSet chosen_set) {              \
    hwy::ChosenTarget chosen;                               \
    chosen.Update(::raymoval::highway_targets(chosen_set)); \
    return HWY_DISPATCH_TABLE(KERNEL)[chosen.GetIndex()];   \
  }(SET))

/// The version for the best set that this processor has, or for that of an `InstructionSetScope`.
#define RAYMOVAL_BEST_KERNEL(KERNEL) RAYMOVAL_KERNEL_FOR(KERNEL, ::raymoval::InstructionSet::kBest)
