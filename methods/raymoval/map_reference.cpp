// SPDX-License-Identifier: MIT
#include "methods/raymoval/map_reference.h"

#include <algorithm>

#include "core/parallel.h"

namespace raymoval {
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

}  // namespace

float percentile_of_sorted(const float* sorted, int count, double quantile) {
  return sorted[static_cast<int>(quantile * (count - 1) + 0.5)];
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

std::vector<float> windowed_minimum(const std::vector<float>& values, const AngularGrid& grid,
                                    int azimuth_radius, int elevation_radius, int threads) {
  // The minimum over a rectangle is the minimum over rows of the minima over columns.
  std::vector<float> along_rows(values.size()), result(values.size());
  const auto rows = static_cast<std::size_t>(grid.elevation_bins);
  const auto pass = [&](const std::vector<float>& from, std::vector<float>& to, int columns,
                        int lines) {
    parallel_for(threads, rows, 8, [&](std::size_t row) {
      for (int i = 0; i < grid.azimuth_bins; ++i) {
        float smallest = kNoRange;
        for_window(from, grid, i, static_cast<int>(row), columns, lines,
                   [&](float value) { smallest = std::min(smallest, value); });
        to[row * static_cast<std::size_t>(grid.azimuth_bins) + static_cast<std::size_t>(i)] =
            smallest;
      }
    });
  };
  pass(values, along_rows, azimuth_radius, 0);
  pass(along_rows, result, 0, elevation_radius);
  return result;
}

}  // namespace raymoval
