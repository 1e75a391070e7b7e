// SPDX-License-Identifier: MIT
// Which instruction sets kernels are compiled for; before the first Highway header.
#pragma once

/// The plain version too, although the whole program may assume more.
#define HWY_COMPILE_ALL_ATTAINABLE
/// Hardly any processor has this and not SSE4; vectors without a fixed size cannot be held in
/// arrays.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
