// SPDX-License-Identifier: MIT
#include "methods/raymoval/kernels/wanted_bins.h"

#include <algorithm>
#include <span>

namespace raymoval::raymoval_method {
namespace {

/// Sets the neighbours of all set bits.
void widen(std::span<std::uint64_t> words) {
  std::uint64_t before = 0;  // The original previous word.
  for (std::size_t w = 0; w < words.size(); ++w) {
    const std::uint64_t here = words[w];
    const std::uint64_t after = w + 1 < words.size() ? words[w + 1] : 0;
    words[w] |= here << 1 | before >> 63 | here >> 1 | after << 63;
    before = here;
  }
}

/// Clears the bits from `rows` on; there is at least one.
void cut(std::span<std::uint64_t> words, std::size_t rows) {
  words.back() &= ~(~std::uint64_t{0} << rows % 64);
}

}  // namespace

void WantedBins::request_all(const AngularGrid& grid) {
  request_around(std::vector<float>(static_cast<std::size_t>(grid.size())), grid, 0);
}

void WantedBins::request_around(const std::vector<float>& values, const AngularGrid& grid,
                                int radius) {
  const auto columns = static_cast<std::size_t>(grid.azimuth_bins);
  const auto rows = static_cast<std::size_t>(grid.elevation_bins);
  words_ = rows / 64 + 1;
  finite_.assign(columns * words_, 0);
  for (std::size_t j = 0; j < rows; ++j) {
    const std::uint64_t bit = std::uint64_t{1} << j % 64;
    const float* row = values.data() + j * columns;
    for (std::size_t i = 0; i < columns; ++i) {
      if (row[i] != kNoRange) finite_[i * words_ + j / 64] |= bit;
    }
  }
  for (std::size_t i = 0; i < columns; ++i) {
    const std::span<std::uint64_t> column(&finite_[i * words_], words_);
    for (int step = 0; step < radius; ++step) widen(column);
    cut(column, rows);
  }
  columns_ = finite_;
  for (int i = 0; i < grid.azimuth_bins; ++i) {
    std::uint64_t* column = &columns_[static_cast<std::size_t>(i) * words_];
    for (int offset = -radius; offset <= radius; ++offset) {
      const int beside = (i + offset + radius * grid.azimuth_bins) % grid.azimuth_bins;
      const std::uint64_t* other = &finite_[static_cast<std::size_t>(beside) * words_];
      for (std::size_t w = 0; w < words_; ++w) column[w] |= other[w];
    }
  }
}

}  // namespace raymoval::raymoval_method
