// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace raymoval::raymoval_plus_method {

/// Steps from column to column, to either side and obliquely, by which ground bounds what is
/// farther away: one after the other, so that the bound reaches as far as all of them together.
inline constexpr int kFarSteps[] = {1, 2, 4, 8, 4, 2, 1};
inline constexpr int kFarReach = 22;

/// By how much the ground of each column may be above that of the column beside it, metres: by as
/// much as the land around rises anyway, and `slope` besides.
/// @param rise_x, rise_y how much the land rises from one column to the next, metres
/// @param cell edge of a column, metres
/// @param slope metres a metre
std::vector<float> highest_rises(const std::vector<float>& rise_x, const std::vector<float>& rise_y,
                                 double cell, double slope);

/// The ground bounded by ground farther away: what few beams find of a vehicle, with metres to the
/// next ring on the ground, is no ground. Columns without ground stay without. The result is that
/// of the columns at least `kFarReach` inside of the square, row by row.
/// @param ground heights of a square of columns, row by row, metres; +infinity where none is known
/// @param side columns in a row
/// @param rises from `highest_rises`
std::vector<float> bounded_from_afar(const std::vector<float>& ground,
                                     const std::vector<float>& rises, int side);

}  // namespace raymoval::raymoval_plus_method
