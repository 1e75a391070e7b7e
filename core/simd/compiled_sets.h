// SPDX-License-Identifier: MIT
// Says for which instruction sets kernels are compiled. The source of a kernel includes it before
// the first Highway header.
#pragma once

/// The plain version is compiled too, even if the whole program may assume more.
#define HWY_COMPILE_ALL_ATTAINABLE
/// Hardly any processor has SSSE3 and not SSE4. Vectors without a fixed size cannot be held in
/// arrays.
#define RAYMOVAL_DISABLED_TARGETS \
  (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
/// For sanitizers the source is the same for all sets: two of them are compiled in half the time.
#ifdef __SANITIZE_ADDRESS__
#define HWY_DISABLED_TARGETS (RAYMOVAL_DISABLED_TARGETS | HWY_SSE4 | HWY_AVX3)
#else
#define HWY_DISABLED_TARGETS RAYMOVAL_DISABLED_TARGETS
#endif
