// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace raymoval::raymoval_plus_method {

/// The land's own slope is a mean over the columns within so many to either side. It is measured
/// between columns that are twice `kHalfLag` apart.
inline constexpr int kLandReach = 20, kHalfLag = 2;
/// Columns to either side that the rise of the land depends on.
inline constexpr int kLandMargin = kLandReach + kHalfLag;

/// How much the land around each column rises along an axis, metres from one column to the next.
/// It is the mean of differences over 1.6 m. Those at the edges of what stands on the land cancel
/// out, and those of more than a metre do not count.
/// @param ground heights of a square of columns, row by row, metres; +infinity where none is known
/// @param side columns in a row
/// @param axis 0 for x, 1 for y
std::vector<float> land_rise(const std::vector<float>& ground, int side, int axis);

/// The ground of a column: a plane over it.
struct GroundPlane {
  float middle;                        ///< Height in the middle of the column, metres.
  float rise_x = 0.0F, rise_y = 0.0F;  ///< From there to the middle of the next column, metres.
  bool operator==(const GroundPlane&) const = default;
};

/// The part of the land's rise that tilts the ground of a column: what is above a tenth. So much
/// may be of things that stand on level land, and the ground may rise by more from column to
/// column.
/// @param rise_x, rise_y metres from one column to the next
/// @param cell edge of a column, metres
/// @return a plane of height 0
GroundPlane steep_part(float rise_x, float rise_y, double cell);

/// How far a low quantile of the heights of a column lies below its middle, metres, if its points
/// are spread evenly over a plane: those of a sum of two uniform distributions.
float quantile_below_middle(const GroundPlane& plane, double quantile);

}  // namespace raymoval::raymoval_plus_method
