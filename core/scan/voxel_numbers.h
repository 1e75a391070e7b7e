// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/scan/voxel_key.h"

namespace raymoval {

/// Numbers voxels 0, 1, 2, ... in the order of insertion, and finds their numbers again. The caller
/// stores the keys by number, so that the table takes 5 to 8 bytes per voxel.
///
/// `key_of(number)` returns the key of an assigned number.
class VoxelNumbers {
 public:
  using Number = std::uint32_t;
  static constexpr Number kNone = std::numeric_limits<Number>::max();

  [[nodiscard]] std::size_t size() const { return size_; }
  /// Bytes of memory of the table.
  [[nodiscard]] std::size_t bytes() const { return table_.capacity() * sizeof(Number); }
  /// Removes all voxels and keeps the memory.
  void clear() {
    if (size_ > 0) std::fill(table_.begin(), table_.end(), kNone);
    size_ = 0;
  }

  /// The number of a voxel; `kNone` if it has none.
  template <class KeyOf>
  [[nodiscard]] Number find(VoxelKey key, KeyOf&& key_of) const {
    return table_.empty() ? kNone : table_[place_of(key, key_of)];
  }

  /// The number of a voxel. A new voxel gets the next number, `size()` before the call; the caller
  /// stores its key for `key_of`.
  template <class KeyOf>
  Number add(VoxelKey key, KeyOf&& key_of) {
    if (5 * (std::size_t{size_} + 1) > 4 * table_.size()) {
      grow(table_.size() + table_.size() / 4, key_of);
    }
    Number& found = table_[place_of(key, key_of)];
    if (found == kNone) found = size_++;
    return found;
  }

  /// Reserves memory for a number of voxels: two places for each, so that missing voxels are found
  /// quickly.
  template <class KeyOf>
  void reserve(std::size_t voxels, KeyOf&& key_of) {
    if (2 * voxels > table_.size()) grow(2 * voxels, key_of);
  }

 private:
  static constexpr std::size_t kFewestPlaces = 1024;

  /// The place of a voxel in the table, or the place where it would be inserted.
  template <class KeyOf>
  [[nodiscard]] std::size_t place_of(VoxelKey key, KeyOf&& key_of) const {
    std::size_t at = first_place(key);
    while (table_[at] != kNone && key_of(table_[at]) != key) at = next(at);
    return at;
  }
  [[nodiscard]] std::size_t first_place(VoxelKey key) const {
    return static_cast<std::size_t>((VoxelKeyHash{}(key) >> 32) * table_.size() >> 32);
  }
  [[nodiscard]] std::size_t next(std::size_t at) const {
    return at + 1 == table_.size() ? 0 : at + 1;
  }

  template <class KeyOf>
  void grow(std::size_t places, KeyOf&& key_of) {
    table_ = {};  // Frees memory before more is allocated.
    table_.assign(std::max(places, kFewestPlaces), kNone);
    for (Number number = 0; number < size_; ++number) {
      std::size_t at = first_place(key_of(number));
      while (table_[at] != kNone) at = next(at);
      table_[at] = number;
    }
  }

  Number size_ = 0;
  std::vector<Number> table_;  ///< `kNone` if there is no voxel.
};

}  // namespace raymoval
