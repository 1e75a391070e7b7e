// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/method_entry.h"

namespace raymoval {
namespace beautymap_method {

/// Parameters of BeautyMap; defaults are those of its public program. Units, ranges and meanings
/// are in entry.cpp.
struct Parameters {
  // The lattice.
  double column_size = 1.0;
  double slice_height = 0.5;
  double window_side = 40.0;
  // Protection from removal.
  double sight_range = 15.0;
  // Behaviour of the public program.
  bool public_lattice = true;
  bool public_outliers = true;
  bool public_rays = true;
  bool public_top = true;
};

/// M. Jia, Q. Zhang, B. Yang, J. Wu, M. Liu, P. Jensfelt: "BeautyMap: Binary-Encoded Adaptable
/// Ground Matrix for Dynamic Points Removal in Global Maps", RA-L 2024. The map is a matrix of
/// columns. A column is a word whose bits are slices of height above the column's foot. A scan has
/// the same form, with the feet of the map's columns.
///  A. Columns of all points of all scans: foot, slices up to the first gap, parts of slices.
///  B. A slice that is occupied in the map and not in a scan is suspicious, except
///     - slices out of the scan's sight (above its steepest ray, above its points in the column, in
///       distant columns without ground, and around the sensor),
///     - a column's lowest slice,
///     - hidden slices: the scan has points on the ray to the slice.
///     Suspicious slices are removed, and the part above the ground of the slice below the lowest
///     of them.
///  C. A point is removed if any scan removes its slice or its part of a slice.
/// Decisions and deviations from the public program: `notes` of the entry.
std::unique_ptr<Remover> make_beautymap(const Parameters& parameters);

}  // namespace beautymap_method

MethodEntry beautymap_entry();

}  // namespace raymoval
