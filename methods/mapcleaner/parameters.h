// SPDX-License-Identifier: MIT
#pragma once

#include "core/scan/sensor_model.h"
#include "methods/common/patchwork/parameters.h"

namespace raymoval::mapcleaner_method {

/// Parameters of MapCleaner; defaults are those of the public program for KITTI. Units, ranges and
/// meanings are in entry.cpp.
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
  // Judged points, and points removed without a vote.
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
  // Behaviour of the public program.
  bool public_field_of_view = true;
  bool public_overwrite = true;
  bool public_steps = true;
};

/// The parameters for a sensor. The published ones are for the HDL-64E of KITTI. Without
/// `public_steps`, a sensor with larger steps gets larger pixels, so that the window around a voxel
/// reaches from one direction to the next and holds ranges to compare with. Bins then need fewer
/// points, in proportion, but at least the points of a plane. Unknown steps change nothing.
Parameters for_sensor(const Parameters& parameters, const SensorModel& sensor);

}  // namespace raymoval::mapcleaner_method
