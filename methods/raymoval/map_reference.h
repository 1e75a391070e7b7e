// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "methods/raymoval/kernels/angular_grid.h"

namespace raymoval::raymoval_method {

/// The value below which the share `quantile` of the sorted values lies: the element of rank
/// round(quantile * (n - 1)), so that the result is always one of the values. Interpolation would
/// give distances between a near and a far surface.
/// @param sorted ascending, not empty
float percentile_of_sorted(const float* sorted, int count, double quantile);

/// Eqs 8-9: for each bin the `quantile` of the finite values in the (2 radius + 1)^2 window around
/// it. The azimuth wraps around; rows beyond the grid are ignored. The result is infinite if the
/// window has no finite value.
std::vector<float> windowed_percentile(const std::vector<float>& values, const AngularGrid& grid,
                                       int radius, double quantile, int threads);

/// Two percentiles of the same windows; one that was not requested is undefined.
struct WindowPercentiles {
  std::vector<float> first, second;
};

/// Eqs 8-9 as in `windowed_percentile`, for two quantiles at once and only for the bins where
/// `wanted` is finite. The values of other bins are undefined.
/// @param percentiles replaced; their memory is used again
void windowed_percentiles(const std::vector<float>& values, const std::vector<float>& wanted,
                          const AngularGrid& grid, int radius,
                          const std::array<std::optional<double>, 2>& quantiles, int threads,
                          WindowPercentiles& percentiles);

/// The bins around a bin of a grid.
struct BinWindow {
  AngularGrid grid;
  int azimuth_radius = 0, elevation_radius = 0;  ///< Columns and rows, to either side.
};

/// The smallest value in the window around one bin.
float windowed_minimum(const std::vector<float>& values, const BinWindow& window, int bin);

}  // namespace raymoval::raymoval_method
