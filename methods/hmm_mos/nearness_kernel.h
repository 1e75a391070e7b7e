// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

/// The innermost loop of the distances. It is compiled for each instruction set.
namespace raymoval::hmm_mos_method::kernels {

/// Rows of bytes that lie `stride` bytes apart, of which some are looked at.
struct NearRows {
  const std::uint8_t* rows = nullptr;  ///< Where row 0 is; 64 bytes each.
  std::ptrdiff_t stride = 0;
  std::uint64_t which = 0;             ///< Bit k: row k is looked at.
  const std::uint8_t* away = nullptr;  ///< By row, how much less near it is.
};

/// Raises bytes of the row `nearest` to the largest of those in the rows, each less what is away,
/// or 0 if that is less: those from `first` to `last`, and perhaps others.
using TakeNearest = void (*)(const NearRows& rows, std::size_t first, std::size_t last,
                             std::uint8_t* nearest);

/// The kernel for the best instruction set that this processor has.
TakeNearest best_take_nearest();

}  // namespace raymoval::hmm_mos_method::kernels
