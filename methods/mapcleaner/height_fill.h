// SPDX-License-Identifier: MIT
#pragma once

#include "methods/mapcleaner/height_grid.h"

namespace raymoval::mapcleaner_method {

/// How cells without a height get one from those around them.
struct Fill {
  double radius = 0.0;     ///< In cells; those nearer than this count. 0 fills nothing.
  double deviation = 1.0;  ///< Metres.
  int least_cells = 1;
};

/// Bayesian generalised kernel inference of terrain in two rounds. The first finds the smooth
/// height of every cell with enough others around it, by a kernel of their distance. The second
/// gives it to cells without a height, and weighs those around by how little they deviate from
/// their own smooth height. Cells with a height keep it.
HeightGrid filled(const HeightGrid& grid, const Fill& fill, int threads);

}  // namespace raymoval::mapcleaner_method
