// SPDX-License-Identifier: MIT
#pragma once

#include "core/parameters.h"

namespace raymoval::beautymap_method {

/// Parameters of BeautyMap; defaults are those of its public program. Their units, ranges and
/// meanings are in `parameter_table()`.
struct Parameters {
  // The lattice.
  double column_size = 1.0;
  double slice_height = 0.5;
  double finest_slice = 0.1;
  double window_side = 40.0;
  // What protects.
  double sight_range = 15.0;
  double blind_range = 2.0;
  int ray_margin = 3;
  // The ground.
  int outlier_neighbours = 5;
  double outlier_share = 0.6;
  double outlier_deviations = 3.0;
  double ground_share = 0.85;
  // As the public program does it.
  bool public_lattice = true;
  bool public_outliers = true;
  bool public_rays = true;
  bool public_top = true;
};

/// The one place where names, units, ranges and sources of the parameters stand.
const ParameterTable<Parameters>& parameter_table();

}  // namespace raymoval::beautymap_method
