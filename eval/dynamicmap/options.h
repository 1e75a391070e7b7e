// SPDX-License-Identifier: MIT
#pragma once

#include "core/parameters.h"

namespace raymoval::dynamicmap {

/// Options of the protocol. The defaults are the benchmark's; its tables were made without a
/// maximum range, its later tools cut at 50 m.
struct Options {
  double distance = 0.05;
  double maximum_range = 0.0;
  double ego_range = 3.0;
  bool ignored_in_estimate = true;
};

const ParameterTable<Options>& option_table();

/// Options of the strict variant.
struct StrictOptions {
  double voxel_size = 0.1;
  double maximum_range = 0.0;
  double ego_range = 3.0;
};

const ParameterTable<StrictOptions>& strict_option_table();

}  // namespace raymoval::dynamicmap
