// SPDX-License-Identifier: MIT
#pragma once

#include "core/parameters.h"

namespace raymoval::dufomap_method {

/// Parameters of DUFOMap; defaults are those of its public configuration.
struct Parameters {
  double voxel_size = 0.1;
  double hit_extension = 0.2;
  int unknown_inflation = 1;
  bool compensate_inflation = true;
  bool pass_through_hits = false;
  double minimum_range = 0.2;
  double maximum_range = 0.0;
  bool offline = true;
};

/// The one place where names, units, ranges and sources of the parameters stand.
const ParameterTable<Parameters>& parameter_table();

}  // namespace raymoval::dufomap_method
