// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace raymoval {

/// The lowest 21 bits of `value` with two zeros between each. Three coordinates, combined by shifts
/// of 0, 1 and 2, give a Morton code: places that are close in space are close in the order of
/// codes.
constexpr std::uint64_t spread_bits(std::uint64_t value) {
  value &= 0x1FFFFF;
  value = (value | value << 32) & 0x1F00000000FFFF;
  value = (value | value << 16) & 0x1F0000FF0000FF;
  value = (value | value << 8) & 0x100F00F00F00F00F;
  value = (value | value << 4) & 0x10C30C30C30C30C3;
  return (value | value << 2) & 0x1249249249249249;
}

}  // namespace raymoval
