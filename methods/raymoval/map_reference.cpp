// SPDX-License-Identifier: MIT
#include "methods/raymoval/map_reference.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "core/simd/compiled_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/raymoval/map_reference.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
//
#include "hwy/highway.h"

#ifndef RAYMOVAL_WINDOW_ROW
#define RAYMOVAL_WINDOW_ROW
namespace raymoval::raymoval_method {

/// One row of eqs 8-9 for windows of 3 x 3.
struct WindowRow {
  std::array<const float*, 3> values{};  ///< The rows above, here and below.
  const float* wanted = nullptr;         ///< Bins with a finite value here are wanted.
  int columns = 0;
  /// Ranks of two percentiles among 1 .. 9 finite values.
  std::array<std::array<int, 10>, 2> ranks{};
  std::array<float*, 2> results{};  ///< Null for a percentile that is not requested.
  float* scratch = nullptr;         ///< 3 x (columns + 2) numbers.
};

struct WindowKernel {
  int lanes;  ///< Bins handled at a time; a row needs at least this number.
  void (*percentiles)(const WindowRow& job);
};

}  // namespace raymoval::raymoval_method
#endif

HWY_BEFORE_NAMESPACE();
namespace raymoval::raymoval_method {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;
using F = hn::Vec<Floats>;

HWY_INLINE void order(F& a, F& b) {
  const F low = hn::Min(a, b);
  b = hn::Max(a, b);
  a = low;
}

/// Sorts the three rows of each column into `scratch`, with one column more at either end.
void sort_columns(const WindowRow& job) {
  const Floats d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const int stride = job.columns + 2;
  for (int next = 0; next < job.columns; next += lanes) {
    const int i = std::min(next, job.columns - lanes);
    F a = hn::LoadU(d, job.values[0] + i);
    F b = hn::LoadU(d, job.values[1] + i);
    F c = hn::LoadU(d, job.values[2] + i);
    order(a, b);
    order(b, c);
    order(a, b);
    hn::StoreU(a, d, job.scratch + i + 1);
    hn::StoreU(b, d, job.scratch + stride + i + 1);
    hn::StoreU(c, d, job.scratch + 2 * stride + i + 1);
  }
  for (int k = 0; k < 3; ++k) {
    float* line = job.scratch + k * stride;
    line[0] = line[job.columns];
    line[job.columns + 1] = line[1];
  }
}

/// Sorts nine values of which three times three are sorted (the rest of Floyd's network).
HWY_INLINE void sort_nine(std::array<F, 9>& v) {
  for (std::size_t k = 0; k < 3; ++k) {
    order(v[k], v[k + 3]);
    order(v[k + 3], v[k + 6]);
    order(v[k], v[k + 3]);
  }
  constexpr std::array<std::pair<std::size_t, std::size_t>, 7> kRest = {
      {{1, 3}, {5, 7}, {2, 6}, {4, 6}, {2, 4}, {2, 3}, {5, 6}}};
  for (const auto& [a, b] : kRest) order(v[a], v[b]);
}

/// The second smallest of nine values of which three times three are sorted: the second smallest of
/// the three smallest, or one of the middle values.
HWY_INLINE F second_smallest(const std::array<F, 9>& v) {
  const F low = hn::Min(v[0], v[3]), high = hn::Max(v[0], v[3]);
  const F middle = hn::Min(v[1], hn::Min(v[4], v[7]));
  return hn::Min(middle, hn::Min(high, hn::Max(low, v[6])));
}

HWY_INLINE F second_largest(const std::array<F, 9>& v) {
  const F low = hn::Min(v[2], v[5]), high = hn::Max(v[2], v[5]);
  const F middle = hn::Max(v[1], hn::Max(v[4], v[7]));
  return hn::Max(middle, hn::Max(low, hn::Min(high, v[8])));
}

/// The value of each window at the rank for its number of finite values.
HWY_INLINE F value_at_rank(const std::array<F, 9>& sorted, const std::array<int, 10>& ranks) {
  const F infinite = hn::Set(Floats(), std::numeric_limits<float>::infinity());
  const auto value_of = [&](std::size_t count) {
    return sorted[static_cast<std::size_t>(ranks[count])];
  };
  // Infinite values come last, so the index of the last finite value gives their number.
  F result = value_of(1);
  for (std::size_t count = 2; count <= 9; ++count) {
    result = hn::IfThenElse(hn::Lt(sorted[count - 1], infinite), value_of(count), result);
  }
  return result;
}

/// The percentiles of the windows around columns i .. i + Lanes - 1.
HWY_INLINE void find_percentiles(const WindowRow& job, int i, hn::Mask<Floats> wanted) {
  const Floats d;
  const F infinite = hn::Set(d, std::numeric_limits<float>::infinity());
  std::array<F, 9> v;
  for (int k = 0; k < 9; ++k) {
    v[static_cast<std::size_t>(k)] =
        hn::LoadU(d, job.scratch + k % 3 * (job.columns + 2) + i + k / 3);
  }
  const F largest = hn::Max(v[2], hn::Max(v[5], v[8]));
  const bool is_full = hn::AllFalse(d, hn::AndNot(hn::Lt(largest, infinite), wanted));
  std::array<F, 9> sorted = v;
  bool is_sorted = false;
  for (std::size_t q = 0; q < 2; ++q) {
    if (job.results[q] == nullptr) continue;
    F result;
    if (is_full && job.ranks[q][9] == 1) {
      result = second_smallest(v);
    } else if (is_full && job.ranks[q][9] == 7) {
      result = second_largest(v);
    } else {
      if (!is_sorted) sort_nine(sorted);
      is_sorted = true;
      result = value_at_rank(sorted, job.ranks[q]);
    }
    hn::StoreU(result, d, job.results[q] + i);
  }
}

void percentiles(const WindowRow& job) {
  const Floats d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const F infinite = hn::Set(d, std::numeric_limits<float>::infinity());
  bool sorted = false;
  for (int next = 0; next < job.columns; next += lanes) {
    const int i = std::min(next, job.columns - lanes);
    const auto wanted = hn::Lt(hn::LoadU(d, job.wanted + i), infinite);
    if (hn::AllFalse(d, wanted)) continue;
    if (!sorted) sort_columns(job);
    sorted = true;
    find_percentiles(job, i, wanted);
  }
}

}  // namespace

WindowKernel window_kernel() {
  return {static_cast<int>(hn::Lanes(Floats())), &percentiles};
}

}  // namespace HWY_NAMESPACE
}  // namespace raymoval::raymoval_method
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "core/simd/instruction_sets.h"

namespace raymoval::raymoval_method {

HWY_EXPORT(window_kernel);

namespace {

/// Calls `visit(value)` for each bin within the window around column `i`, row `j`.
template <class Visit>
void for_window(const std::vector<float>& values, const AngularGrid& grid, int i, int j,
                int azimuth_radius, int elevation_radius, Visit&& visit) {
  const int first = std::max(0, j - elevation_radius);
  const int last = std::min(grid.elevation_bins - 1, j + elevation_radius);
  for (int row = first; row <= last; ++row) {
    const float* line = values.data() + static_cast<std::ptrdiff_t>(row) * grid.azimuth_bins;
    for (int offset = -azimuth_radius; offset <= azimuth_radius; ++offset) {
      visit(line[wrap_azimuth(i + offset, grid.azimuth_bins)]);
    }
  }
}

int percentile_rank(int count, double quantile) {
  return static_cast<int>(std::floor(quantile * (count - 1) + 0.5));
}

}  // namespace

float percentile_of_sorted(const float* sorted, int count, double quantile) {
  return sorted[percentile_rank(count, quantile)];
}

std::vector<float> windowed_percentile(const std::vector<float>& values, const AngularGrid& grid,
                                       int radius, double quantile, int threads) {
  std::vector<float> result(values.size(), kNoRange);
  const auto rows = static_cast<std::size_t>(grid.elevation_bins);
  parallel_for(threads, rows, 8, [&](std::size_t row) {
    std::vector<float> window;
    for (int i = 0; i < grid.azimuth_bins; ++i) {
      window.clear();
      for_window(values, grid, i, static_cast<int>(row), radius, radius, [&](float value) {
        if (value != kNoRange) window.push_back(value);
      });
      if (window.empty()) continue;
      std::sort(window.begin(), window.end());
      result[row * static_cast<std::size_t>(grid.azimuth_bins) + static_cast<std::size_t>(i)] =
          percentile_of_sorted(window.data(), static_cast<int>(window.size()), quantile);
    }
  });
  return result;
}

void windowed_percentiles(const std::vector<float>& values, const std::vector<float>& wanted,
                          const AngularGrid& grid, int radius,
                          const std::array<std::optional<double>, 2>& quantiles, int threads,
                          WindowPercentiles& percentiles) {
  const WindowKernel kernel = RAYMOVAL_BEST_KERNEL(window_kernel)();
  const std::array<std::vector<float>*, 2> results = {&percentiles.first, &percentiles.second};
  if (radius != 1 || grid.azimuth_bins < kernel.lanes) {
    for (std::size_t q = 0; q < 2; ++q) {
      if (!quantiles[q]) continue;
      *results[q] = windowed_percentile(values, grid, radius, *quantiles[q], threads);
    }
    return;
  }
  for (std::vector<float>* result : results) result->resize(values.size());
  const auto columns = static_cast<std::size_t>(grid.azimuth_bins);
  const auto rows = static_cast<std::size_t>(grid.elevation_bins);
  const std::vector<float> beyond(columns, kNoRange);
  WindowRow shared;
  shared.columns = grid.azimuth_bins;
  for (std::size_t q = 0; q < 2; ++q) {
    for (int count = 1; quantiles[q] && count <= 9; ++count) {
      shared.ranks[q][static_cast<std::size_t>(count)] = percentile_rank(count, *quantiles[q]);
    }
  }
  parallel_chunks(threads, rows, 16, [&](std::size_t begin, std::size_t end) {
    std::vector<float> scratch(3 * (columns + 2));
    WindowRow job = shared;
    job.scratch = scratch.data();
    for (std::size_t row = begin; row < end; ++row) {
      const float* here = values.data() + row * columns;
      job.values = {row == 0 ? beyond.data() : here - columns, here,
                    row + 1 == rows ? beyond.data() : here + columns};
      job.wanted = wanted.data() + row * columns;
      for (std::size_t q = 0; q < 2; ++q) {
        job.results[q] = quantiles[q] ? results[q]->data() + row * columns : nullptr;
      }
      kernel.percentiles(job);
    }
  });
}

float windowed_minimum(const std::vector<float>& values, const BinWindow& window, int bin) {
  float smallest = kNoRange;
  for_window(values, window.grid, window.grid.azimuth_of(bin), window.grid.elevation_of(bin),
             window.azimuth_radius, window.elevation_radius,
             [&](float value) { smallest = std::min(smallest, value); });
  return smallest;
}

}  // namespace raymoval::raymoval_method
#endif
