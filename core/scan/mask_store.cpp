// SPDX-License-Identifier: MIT
#include "core/scan/mask_store.h"

#include <algorithm>
#include <array>
#include <bit>

namespace raymoval {
namespace {

using Eight = std::array<std::uint8_t, 8>;

/// The masks of eight points by their bits, the first in the lowest one.
constexpr std::array<Eight, 256> kMasksOfBits = [] {
  std::array<Eight, 256> masks{};
  for (std::size_t bits = 0; bits < masks.size(); ++bits) {
    for (std::size_t i = 0; i < 8; ++i) {
      masks[bits][i] = static_cast<std::uint8_t>(bits >> i & 1U);
    }
  }
  return masks;
}();

}  // namespace

void MaskStore::set(std::size_t scan, const Mask& mask) {
  Packed& packed = scans_[scan];
  packed.filled = true;
  packed.points = mask.size();
  packed.words.assign((mask.size() + 63) / 64, 0);
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] != 0) packed.words[i / 64] |= std::uint64_t{1} << (i % 64);
  }
}

Mask MaskStore::get(std::size_t scan) const {
  const Packed& packed = scans_[scan];
  Mask mask(packed.points);
  for (std::size_t first = 0; first < mask.size(); first += 8) {
    const Eight& eight = kMasksOfBits[packed.words[first / 64] >> (first % 64) & 0xFFU];
    std::copy_n(eight.data(), std::min<std::size_t>(8, mask.size() - first), mask.data() + first);
  }
  return mask;
}

std::size_t MaskStore::removed_count() const {
  std::size_t count = 0;
  for (const Packed& packed : scans_) {
    for (const std::uint64_t word : packed.words) {
      count += static_cast<std::size_t>(std::popcount(word));
    }
  }
  return count;
}

}  // namespace raymoval
