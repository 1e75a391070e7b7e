// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/scan/scan.h"

namespace raymoval {

/// Removal masks of a sequence, at most one bit and a thirty-second per point. 64 points that
/// follow each other and are all kept, or all removed, take a thirty-second of that: masks of
/// methods take much less than a bit per point, those that keep or remove everything next to none.
class MaskStore {
 public:
  MaskStore() = default;
  explicit MaskStore(std::size_t scan_count) : scans_(scan_count) {}
  [[nodiscard]] std::size_t size() const { return scans_.size(); }
  [[nodiscard]] bool has(std::size_t scan) const { return scans_[scan].filled; }
  /// Keeps the mask of scan `scan`. Different scans may be set from different threads.
  void set(std::size_t scan, const Mask& mask);
  /// The mask of scan `scan`; empty if none was set (see `has`).
  [[nodiscard]] Mask get(std::size_t scan) const;
  [[nodiscard]] std::size_t point_count(std::size_t scan) const { return scans_[scan].points; }
  [[nodiscard]] std::size_t removed_count() const;
  /// What the masks take in memory.
  [[nodiscard]] std::size_t bytes() const;

 private:
  /// Points stand in words of 64. Words in which all bits are the same are not kept.
  struct Packed {
    bool filled = false;
    std::size_t points = 0;
    /// For each 64 words of the mask two: which of them are kept, and which of the others have all
    /// bits set. Then the words that are kept, in order.
    std::vector<std::uint64_t> words;
  };
  std::vector<Packed> scans_;
};

}  // namespace raymoval
