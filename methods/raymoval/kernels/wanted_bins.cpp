// SPDX-License-Identifier: MIT
#include "methods/raymoval/kernels/wanted_bins.h"

#include <algorithm>

#include "methods/raymoval/kernels/image_kernels.h"

namespace raymoval::raymoval_method {
namespace {

constexpr std::size_t kBits = 64;

/// A circle of bits in words of 64; those beyond the last column are 0.
struct Circle {
  std::uint64_t* words;
  std::size_t count, columns;

  [[nodiscard]] bool at(std::size_t column) const {
    return (words[column / kBits] >> column % kBits & 1) != 0;
  }
};

/// Sets the neighbours of all bits that are set.
void widen(const Circle& row) {
  const bool first = row.at(0), last = row.at(row.columns - 1);
  std::uint64_t before = 0;  // The word before, as it was.
  for (std::size_t w = 0; w < row.count; ++w) {
    const std::uint64_t here = row.words[w];
    const std::uint64_t after = w + 1 < row.count ? row.words[w + 1] : 0;
    row.words[w] |= here << 1 | before >> 63 | here >> 1 | after << 63;
    before = here;
  }
  if (row.columns % kBits != 0)
    row.words[row.count - 1] &= ~(~std::uint64_t{0} << row.columns % kBits);
  if (first) row.words[row.count - 1] |= std::uint64_t{1} << (row.columns - 1) % kBits;
  if (last) row.words[0] |= 1;
}

}  // namespace

void transpose_bits(std::array<std::uint64_t, 64>& words) {
  // Swaps ever smaller squares (Warren, Hacker's Delight, 7-3).
  std::uint64_t mask = 0x00000000FFFFFFFFULL;
  for (std::size_t side = 32; side > 0; side /= 2, mask ^= mask << side) {
    for (std::size_t a = 0; a < kBits; a = (a + side + 1) & ~side) {
      const std::uint64_t swapped = (words[a] >> side ^ words[a + side]) & mask;
      words[a] ^= swapped << side;
      words[a + side] ^= swapped;
    }
  }
}

void WantedBins::resize(const AngularGrid& grid) {
  words_ = static_cast<std::size_t>(grid.elevation_bins) / kBits + 1;
  columns_.resize(words_ * static_cast<std::size_t>(grid.azimuth_bins));
}

void WantedBins::ask_for_all(const AngularGrid& grid) {
  resize(grid);
  const auto rows = static_cast<std::size_t>(grid.elevation_bins);
  for (std::size_t at = 0; at < columns_.size(); ++at) {
    const std::size_t first = at % words_ * kBits;
    columns_[at] =
        first + kBits <= rows ? ~std::uint64_t{0} : ~(~std::uint64_t{0} << (rows - first));
  }
}

void WantedBins::ask_around(const std::vector<float>& values, const AngularGrid& grid, int radius) {
  resize(grid);
  const auto columns = static_cast<std::size_t>(grid.azimuth_bins);
  const auto rows = static_cast<std::size_t>(grid.elevation_bins);
  const auto reach = static_cast<std::size_t>(radius);
  const std::size_t words = (columns + kBits - 1) / kBits;
  const kernels::ImageKernels kernel = kernels::best_image_kernels();
  rows_.resize(rows * words);
  for (std::size_t j = 0; j < rows; ++j) {
    kernel.finite(values.data() + j * columns, columns, rows_.data() + j * words);
    for (std::size_t turn = 0; turn < reach; ++turn) widen({&rows_[j * words], words, columns});
  }
  widened_.assign(rows_.size(), 0);
  for (std::size_t j = 0; j < rows; ++j) {
    for (std::size_t near = j - std::min(j, reach); near <= std::min(j + reach, rows - 1); ++near) {
      for (std::size_t w = 0; w < words; ++w) widened_[j * words + w] |= rows_[near * words + w];
    }
  }
  std::array<std::uint64_t, kBits> square;
  for (std::size_t from = 0; from < words_; ++from) {
    for (std::size_t w = 0; w < words; ++w) {
      for (std::size_t j = 0; j < kBits; ++j) {
        const std::size_t row = from * kBits + j;
        square[j] = row < rows ? widened_[row * words + w] : 0;
      }
      transpose_bits(square);
      const std::size_t last = std::min(kBits, columns - w * kBits);
      for (std::size_t i = 0; i < last; ++i) columns_[(w * kBits + i) * words_ + from] = square[i];
    }
  }
}

}  // namespace raymoval::raymoval_method
