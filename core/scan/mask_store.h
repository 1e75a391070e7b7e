// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/scan/scan.h"

namespace raymoval {

/// Removal masks of a sequence, one bit per point.
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

 private:
  struct Packed {
    bool filled = false;
    std::size_t points = 0;
    std::vector<std::uint64_t> words;
  };
  std::vector<Packed> scans_;
};

}  // namespace raymoval
