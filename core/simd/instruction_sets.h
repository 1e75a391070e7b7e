// SPDX-License-Identifier: MIT
// For the sources of kernels, after HWY_EXPORT: calls functions that are compiled once for each
// instruction set.
#pragma once

#include <cstdint>

#include "hwy/highway.h"

namespace raymoval {

/// Highway's bits for the vectors that kernels may use on this processor. 0 means none: the plain
/// version.
std::int64_t highway_targets();

}  // namespace raymoval

/// The version of a kernel, declared by HWY_EXPORT, for the best set of this processor, or for the
/// set of an `InstructionSetScope`.
#define RAYMOVAL_BEST_KERNEL(KERNEL)                      \
  ([] {                                                   \
    hwy::ChosenTarget chosen;                             \
    chosen.Update(::raymoval::highway_targets());         \
    return HWY_DISPATCH_TABLE(KERNEL)[chosen.GetIndex()]; \
  }())
