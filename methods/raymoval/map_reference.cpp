// SPDX-License-Identifier: MIT
#include "methods/raymoval/map_reference.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/simd/simd.h"
#include "methods/raymoval/kernels/image_kernels.h"

namespace raymoval::raymoval_method {
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
  const kernels::ImageKernels kernel = kernels::best_image_kernels();
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
  kernels::WindowRow shared;
  shared.columns = grid.azimuth_bins;
  for (std::size_t q = 0; q < 2; ++q) {
    for (int count = 1; quantiles[q] && count <= 9; ++count) {
      shared.ranks[q][static_cast<std::size_t>(count)] = percentile_rank(count, *quantiles[q]);
    }
  }
  parallel_chunks(threads, rows, 16, [&](std::size_t begin, std::size_t end) {
    std::vector<float> scratch(3 * (columns + 2));
    kernels::WindowRow job = shared;
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

void windowed_minimum(const std::vector<float>& values, const AngularGrid& grid, int azimuth_radius,
                      int elevation_radius, int threads, std::vector<float>& minimum) {
  const kernels::ImageKernels kernel = kernels::best_image_kernels();
  minimum.resize(values.size());
  if (grid.azimuth_bins < kernel.lanes + azimuth_radius) {
    for (int bin = 0; bin < grid.size(); ++bin) {
      minimum[static_cast<std::size_t>(bin)] =
          windowed_minimum(values, {grid, azimuth_radius, elevation_radius}, bin);
    }
    return;
  }
  kernels::WindowMinimum shared;
  shared.values = values.data();
  shared.result = minimum.data();
  shared.columns = grid.azimuth_bins;
  shared.rows = grid.elevation_bins;
  shared.azimuth_radius = azimuth_radius;
  shared.elevation_radius = elevation_radius;
  const auto columns = static_cast<std::size_t>(grid.azimuth_bins);
  const auto lanes = static_cast<std::size_t>(kernel.lanes);
  const std::size_t strips = (columns + lanes - 1) / lanes;
  parallel_chunks(threads, strips, 8, [&](std::size_t begin, std::size_t end) {
    AlignedArray<float> scratch;
    scratch.require(lanes * static_cast<std::size_t>(grid.elevation_bins + 2 * elevation_radius));
    kernels::WindowMinimum job = shared;
    job.scratch = scratch.data();
    for (std::size_t strip = begin; strip < end; ++strip) {
      const std::size_t first = std::min(strip * lanes, columns - lanes);
      kernel.minimum(job, static_cast<int>(first), static_cast<int>(strip * lanes - first));
    }
  });
}

}  // namespace raymoval::raymoval_method
