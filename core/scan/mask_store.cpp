// SPDX-License-Identifier: MIT
#include "core/scan/mask_store.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string>

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

constexpr std::size_t kBits = 64;
constexpr std::size_t kWordBytes = sizeof(std::uint64_t);
constexpr std::uint64_t kAllBits = ~std::uint64_t{0};

/// Number of words for `bits` bits.
constexpr std::size_t words_for(std::size_t bits) {
  return (bits + kBits - 1) / kBits;
}

constexpr bool has_bit(std::uint64_t word, std::size_t bit) {
  return (word >> bit & 1U) != 0;
}

/// The bits of up to 64 points of a mask.
std::uint64_t bits_of(const std::uint8_t* mask, std::size_t points) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < points; ++i) bits |= std::uint64_t{mask[i] != 0} << i;
  return bits;
}

}  // namespace

void MaskStore::set(std::size_t scan, const Mask& mask) {
  const std::size_t words = words_for(mask.size());
  std::vector<std::uint64_t> packed(2 * words_for(words), 0);
  std::size_t removed = 0;
  for (std::size_t i = 0; i < words; ++i) {
    const std::size_t first = i * kBits;
    const std::uint64_t bits = bits_of(mask.data() + first, std::min(kBits, mask.size() - first));
    if (bits == 0) continue;
    removed += static_cast<std::size_t>(std::popcount(bits));
    packed[i / kBits * 2 + (bits == kAllBits ? 1 : 0)] |= std::uint64_t{1} << (i % kBits);
    if (bits != kAllBits) packed.push_back(bits);
  }
  spool_.put(scan, {reinterpret_cast<const char*>(packed.data()), packed.size() * kWordBytes});
  counts_[scan] = {mask.size(), removed};
}

Mask MaskStore::get(std::size_t scan) const {
  const std::string bytes = spool_.get(scan);
  std::vector<std::uint64_t> packed(bytes.size() / kWordBytes);
  std::copy_n(bytes.data(), packed.size() * kWordBytes, reinterpret_cast<char*>(packed.data()));
  Mask mask(counts_[scan].points);
  const std::size_t words = words_for(mask.size());
  std::size_t next = 2 * words_for(words);
  for (std::size_t i = 0; i < words; ++i) {
    const std::uint64_t* const group = packed.data() + i / kBits * 2;
    std::uint8_t* const points = mask.data() + i * kBits;
    if (has_bit(group[1], i % kBits)) std::fill_n(points, kBits, std::uint8_t{1});
    if (!has_bit(group[0], i % kBits)) continue;
    const std::uint64_t bits = packed[next++];
    const std::size_t count = std::min(kBits, mask.size() - i * kBits);
    for (std::size_t first = 0; first < count; first += 8) {
      const Eight& eight = kMasksOfBits[bits >> first & 0xFFU];
      std::copy_n(eight.data(), std::min<std::size_t>(8, count - first), points + first);
    }
  }
  return mask;
}

std::size_t MaskStore::point_count() const {
  std::size_t points = 0;
  for (const Counts& counts : counts_) points += counts.points;
  return points;
}

std::size_t MaskStore::removed_count() const {
  std::size_t removed = 0;
  for (const Counts& counts : counts_) removed += counts.removed;
  return removed;
}

std::size_t MaskStore::bytes() const {
  return counts_.size() * sizeof(Counts) + spool_.bytes();
}

}  // namespace raymoval
