// SPDX-License-Identifier: MIT
// Says for which instruction sets kernels are compiled. The source of a kernel includes it before
// the first Highway header.
#pragma once

/// The plain version is compiled too, even if the whole program may assume more.
#define HWY_COMPILE_ALL_ATTAINABLE
/// Three sets are compiled on x86: plain, SSE4 and AVX2. AVX-512 gains a fifth over AVX2 on few
/// processors, and costs as much to compile. Vectors without a fixed size cannot be held in arrays.
#define HWY_DISABLED_TARGETS \
  (HWY_SSSE3 | HWY_AVX3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
