// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace raymoval::raymoval_plus_method {

/// A column is compared with those around it, so many to either side: 3.6 m across with columns of
/// 0.4 m, more than a pit of false echoes is wide. With fewer than `kLeastPitNeighbours` that have
/// ground it is dropped.
inline constexpr int kPitNeighbours = 4, kLeastPitNeighbours = 4;

/// The ground without the columns that lie more than `drop` below the lower quartile of those
/// around them, themselves included.
/// @param ground heights of a square of columns, row by row, metres; +infinity where none is known
/// @param side columns in a row
std::vector<float> without_pits(const std::vector<float>& ground, int side, float drop);

}  // namespace raymoval::raymoval_plus_method
