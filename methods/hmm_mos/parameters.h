// SPDX-License-Identifier: MIT
#pragma once

#include "core/parameters.h"

namespace raymoval::hmm_mos_method {

/// Parameters of HMM-MOS; defaults are those of its public program's configurations. Their units,
/// ranges and meanings are in `parameter_table()`.
struct Parameters {
  // What is taken of a scan.
  double voxel_size = 0.25;
  double min_range = 0.5;
  double max_range = 50.0;
  // The state of a voxel.
  double spread = 1.0;
  double transition = 0.005;
  double belief = 0.99;
  // What is forgotten.
  int map_scans = 300;
  double map_range_factor = 1.5;
  // What changed.
  int reach = 2;
  int window_scans = 5;
  int bins = 100;
  double least_threshold = 3.0;
  // As the public program does it.
  bool public_lattice = true;
  // Ours.
  bool offline = false;
};

/// The one place where names, units, ranges and sources of the parameters stand.
const ParameterTable<Parameters>& parameter_table();

}  // namespace raymoval::hmm_mos_method
