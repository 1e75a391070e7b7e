// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "eval/lattice/cell_lattice.h"

namespace raymoval {

/// A bit for each of many numbers. The set bits are ranked, so that a table needs memory for these
/// numbers only. It takes a fifth of a byte per number.
class RankedBits {
 public:
  RankedBits() = default;
  explicit RankedBits(std::size_t numbers) : words_((numbers + 63) / 64, 0) {}

  /// Several threads may set bits at a time.
  void set(std::size_t number) {
    const std::atomic_ref<std::uint64_t> word(words_[number / 64]);
    if ((word.load(std::memory_order_relaxed) & bit(number)) == 0) {
      word.fetch_or(bit(number), std::memory_order_relaxed);
    }
  }
  [[nodiscard]] bool test(std::size_t number) const {
    return (words_[number / 64] & bit(number)) != 0;
  }

  /// Ranks the set bits. `count` and `rank` hold until the next bit is set.
  void count_through() {
    ranks_.clear();
    ranks_.reserve(words_.size());
    count_ = 0;
    for (const std::uint64_t word : words_) {
      ranks_.push_back(static_cast<std::uint32_t>(count_));
      count_ += static_cast<std::size_t>(std::popcount(word));
    }
  }
  [[nodiscard]] std::size_t count() const { return count_; }
  /// How many lower numbers are set.
  [[nodiscard]] std::uint32_t rank(std::size_t number) const {
    const std::uint64_t lower = words_[number / 64] & (bit(number) - 1);
    return ranks_[number / 64] + static_cast<std::uint32_t>(bits_set(lower));
  }

  /// Calls `visit(number)` for each number whose bit is set, in order.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (std::size_t i = 0; i < words_.size(); ++i) {
      for (std::uint64_t left = words_[i]; left != 0; left &= left - 1) {
        visit(static_cast<std::uint32_t>(64 * i) +
              static_cast<std::uint32_t>(std::countr_zero(left)));
      }
    }
  }

  /// Bytes of memory.
  [[nodiscard]] std::size_t bytes() const {
    return words_.capacity() * sizeof(std::uint64_t) + ranks_.capacity() * sizeof(std::uint32_t);
  }

 private:
  static std::uint64_t bit(std::size_t number) { return std::uint64_t{1} << (number % 64); }

  std::vector<std::uint64_t> words_;
  std::vector<std::uint32_t> ranks_;  ///< For each word how many bits are set before it.
  std::size_t count_ = 0;
};

}  // namespace raymoval
