// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/method_entry.h"

namespace raymoval {
namespace beautymap_method {

/// Parameters of BeautyMap; defaults are those of its public program. Their units, ranges and
/// meanings stand in entry.cpp.
struct Parameters {
  // The lattice.
  double column_size = 1.0;
  double slice_height = 0.5;
  double window_side = 40.0;
  // What protects.
  double sight_range = 15.0;
  // As the public program does it.
  bool public_lattice = true;
  bool public_outliers = true;
  bool public_rays = true;
  bool public_top = true;
};

/// M. Jia, Q. Zhang, B. Yang, J. Wu, M. Liu, P. Jensfelt: "BeautyMap: Binary-Encoded Adaptable
/// Ground Matrix for Dynamic Points Removal in Global Maps", RA-L 2024. The map is a matrix of
/// columns, each a word whose bits are slices of height above its own foot; so is each scan, by the
/// feet of the map's columns.
///  A. Columns of all points of all scans: foot, slices up to the first gap, parts of slices.
///  B. What the map has and a scan has not is suspicious, but for
///     - what is out of the scan's sight (above its steepest ray, above what it sees in the column,
///       columns far off without ground, and around the sensor),
///     - a column's lowest slice,
///     - what is hidden: the scan has something on the ray to it.
///     Suspicious slices go, and of the slice below the lowest of them what is above the ground.
///  C. A point goes if its slice, or its part of a slice, goes by any scan.
/// Decisions and deviations from the public program: `notes` of the entry.
std::unique_ptr<Remover> make_beautymap(const Parameters& parameters);

}  // namespace beautymap_method

MethodEntry beautymap_entry();

}  // namespace raymoval
