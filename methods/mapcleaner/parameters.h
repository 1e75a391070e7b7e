// SPDX-License-Identifier: MIT
#pragma once

#include "core/scan/sensor_model.h"
#include "methods/common/patchwork/parameters.h"

namespace raymoval::mapcleaner_method {

/// Parameters of MapCleaner; defaults are those of the public program for KITTI. Their units,
/// ranges and meanings stand in entry.cpp.
struct Parameters : patchwork::GroundParameters {
  // The terrain.
  double terrain_cell = 0.2;
  int terrain_points = 1;
  double terrain_variance = 0.01;
  double fill_radius = 1.0;
  double fill_deviation = 1.0;
  int fill_cells = 3;
  double terrain_slope = 15.0;
  double start_radius = 0.0;
  double refill_radius = 2.0;
  double refill_deviation = 0.5;
  // What is judged, and what goes unjudged.
  double ground_height = 0.172;
  bool remove_below = true;
  double voxel_size = 0.2;
  // The votes.
  double column_width = 0.16;
  double row_height = 0.4;
  double vertical_view = 30.0;
  int window_columns = 2;
  int window_rows = 1;
  double tolerance = 0.5;
  double submap_radius = 70.0;
  double submap_travel = 10.0;
  // As the public program does it.
  bool public_field_of_view = true;
  bool public_overwrite = true;
  bool public_steps = true;
};

/// The parameters for a sensor. They are set for the HDL-64E of KITTI. Unless `public_steps`, the
/// pixels for a sensor whose directions are far apart are as large as it takes for the window
/// around a voxel to reach from one direction to the next, so that there is something to compare it
/// with; and bins ask for as many points fewer as the sensor leaves there, but for no fewer than
/// span a plane. Steps that are unknown change nothing.
Parameters for_sensor(const Parameters& parameters, const SensorModel& sensor);

}  // namespace raymoval::mapcleaner_method
