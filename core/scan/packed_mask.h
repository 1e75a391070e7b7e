// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "core/scan/scan.h"

namespace raymoval {

/// A mask with one bit per point: the first point is the lowest bit of the first byte.
inline std::string packed_mask(const Mask& mask) {
  std::string bits((mask.size() + 7) / 8, '\0');
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] != 0) bits[i / 8] = static_cast<char>(bits[i / 8] | (1 << (i % 8)));
  }
  return bits;
}

/// The mask of `points` points that `packed_mask` has packed.
inline Mask unpacked_mask(const std::string& bits, std::size_t points) {
  Mask mask(points);
  for (std::size_t i = 0; i < points; ++i) {
    mask[i] = static_cast<std::uint8_t>(static_cast<unsigned char>(bits[i / 8]) >> (i % 8) & 1U);
  }
  return mask;
}

}  // namespace raymoval
