// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "methods/raymoval/map_reference.h"

namespace raymoval::raymoval_test {
using namespace raymoval::raymoval_method;

/// The values within a number of columns and rows around a bin.
inline std::vector<float> values_around(const std::vector<float>& values, const BinWindow& window,
                                        int bin) {
  const AngularGrid& grid = window.grid;
  std::vector<float> around;
  for (int dj = -window.elevation_radius; dj <= window.elevation_radius; ++dj) {
    for (int di = -window.azimuth_radius; di <= window.azimuth_radius; ++di) {
      const int n = grid.azimuth_bins, j = grid.elevation_of(bin) + dj;
      if (j < 0 || j >= grid.elevation_bins) continue;
      const int i = ((grid.azimuth_of(bin) + di) % n + n) % n;
      around.push_back(values[static_cast<std::size_t>(j * n + i)]);
    }
  }
  return around;
}

}  // namespace raymoval::raymoval_test
