// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace raymoval::kernels_bench {

/// The name of the work that `run_yardstick` does. It changes whenever that work changes, so that
/// figures of two yardsticks are never compared.
inline constexpr const char* kYardstick = "sort, gather and root 1";

/// Does a fixed work on one thread: it sorts 500,000 keys, reads 4,000,000 values of 32 MiB in
/// random order, and takes 8,000,000 square roots, as voxel maps and range images do. It uses no
/// code of this project, so that its time depends on the machine only.
/// @return a value that depends on all of the work
std::uint64_t run_yardstick();

}  // namespace raymoval::kernels_bench
