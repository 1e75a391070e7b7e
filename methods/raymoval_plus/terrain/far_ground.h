// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace raymoval::raymoval_plus_method {

/// Steps from column to column, to either side and obliquely, by which ground bounds what is
/// farther away: one after the other, so that the bound reaches as far as all of them together.
inline constexpr int kFarSteps[] = {1, 2, 4, 8, 4, 2, 1};
inline constexpr int kFarReach = 22;
/// The land's own slope is a mean over the columns within so many to either side. It is measured
/// between columns that are twice `kHalfLag` apart.
inline constexpr int kLandReach = 20, kHalfLag = 2;
/// Columns to either side that the rise of the land depends on.
inline constexpr int kLandMargin = kLandReach + kHalfLag;

/// By how much the ground of each column may be above that of the column beside it, metres: by as
/// much as the land around rises anyway, and `slope` besides. The land's slope is the mean of
/// differences over 1.6 m, of which those at the edges of things that stand on it cancel out.
/// @param ground heights of a square of columns, row by row, metres; +infinity where none is known
/// @param side columns in a row
/// @param cell edge of a column, metres
/// @param slope metres a metre
std::vector<float> highest_rises(const std::vector<float>& ground, int side, double cell,
                                 double slope);

/// The ground bounded by ground farther away: what few beams find of a vehicle, with metres to the
/// next ring on the ground, is no ground. Columns without ground stay without. The result depends
/// on `kFarReach` columns to either side.
/// @param ground, side as above
/// @param rises from `highest_rises`
std::vector<float> bounded_from_afar(const std::vector<float>& ground,
                                     const std::vector<float>& rises, int side);

}  // namespace raymoval::raymoval_plus_method
