// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/scan/scan.h"
#include "core/scan/scan_spool.h"

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

/// Removal masks of a sequence, at most one bit and a thirty-second per point. 64 consecutive
/// points that are all kept, or all removed, take a thirty-second of that. So masks of methods take
/// much less than a bit per point, and masks that keep or remove everything almost nothing.
class MaskStore {
 public:
  /// Keeps the masks in memory.
  MaskStore() = default;
  explicit MaskStore(std::size_t scan_count) : MaskStore(ScanSpool(scan_count)) {}
  /// Keeps the masks in `spool`, which is empty.
  explicit MaskStore(ScanSpool spool) : counts_(spool.size()), spool_(std::move(spool)) {}
  [[nodiscard]] std::size_t size() const { return counts_.size(); }
  [[nodiscard]] bool has(std::size_t scan) const { return spool_.has(scan); }
  /// Keeps the mask of scan `scan`. Different scans may be set from different threads.
  void set(std::size_t scan, const Mask& mask);
  /// The mask of scan `scan`; empty if none was set (see `has`).
  [[nodiscard]] Mask get(std::size_t scan) const;
  [[nodiscard]] std::size_t point_count(std::size_t scan) const { return counts_[scan].points; }
  /// Of all scans.
  [[nodiscard]] std::size_t point_count() const;
  [[nodiscard]] std::size_t removed_count() const;
  /// Bytes of memory of the masks.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Counts {
    std::size_t points = 0, removed = 0;
  };
  std::vector<Counts> counts_;
  /// A word has the bits of 64 points. Words in which all bits are equal are not stored. For each
  /// 64 words of a mask there are two index words: which words are stored, and which of the others
  /// have all bits set. The stored words follow in order.
  ScanSpool spool_;
};

}  // namespace raymoval
