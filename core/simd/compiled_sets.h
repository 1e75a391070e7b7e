// SPDX-License-Identifier: MIT
// Says for which instruction sets kernels are compiled. The source of a kernel includes it before
// the first Highway header.
#pragma once

/// The plain version is compiled too, even if the whole program may assume more.
#define HWY_COMPILE_ALL_ATTAINABLE
/// Each set costs compile time, so x86 has three: plain, SSE4 and AVX2. AVX-512 takes 2.8 ms where
/// AVX2 takes 3.6 and SSE4 6.4 for the largest kernel (methods/raymoval/KERNELS.md);
/// processors without AVX2 would take 56. Vectors without a fixed size cannot be held in arrays.
#define HWY_DISABLED_TARGETS \
  (HWY_SSSE3 | HWY_AVX3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
