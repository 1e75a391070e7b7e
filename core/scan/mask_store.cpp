// SPDX-License-Identifier: MIT
#include "core/scan/mask_store.h"

#include <bit>

namespace raymoval {

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
  for (std::size_t i = 0; i < mask.size(); ++i) {
    mask[i] = static_cast<std::uint8_t>(packed.words[i / 64] >> (i % 64) & 1U);
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
