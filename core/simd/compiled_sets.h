// SPDX-License-Identifier: MIT
// Defines the instruction sets for which kernels are compiled. The source of a kernel includes it
// before the first Highway header.
#pragma once

/// The plain version is compiled too, even if the whole program may assume more.
#define HWY_COMPILE_ALL_ATTAINABLE
/// Each set costs compile time, so x86 has three: plain, SSE4 and AVX2. The largest kernel takes
/// 2.8 ms with AVX-512, 3.6 with AVX2, 6.4 with SSE4 and 56 with plain code
/// (methods/raymoval/KERNELS.md). Vectors without a fixed size cannot be elements of arrays.
#define HWY_DISABLED_TARGETS \
  (HWY_SSSE3 | HWY_AVX3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
