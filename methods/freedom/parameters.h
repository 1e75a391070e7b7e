// SPDX-License-Identifier: MIT
#pragma once

#include "core/parameters.h"

namespace raymoval::freedom_method {

/// Neighbourhoods by which levels grow: neighbours across faces, edges, corners, or two rounds.
enum class Neighbours { k6, k18, k26, k80, k124 };

/// Parameters of FreeDOM; defaults are those of its public program for KITTI. Their units, ranges
/// and meanings are in `parameter_table()`.
struct Parameters {
  // The lattice.
  double sub_voxel_size = 0.1;
  int sub_voxels = 4;
  // The points of a scan, and its rays.
  double minimum_range = 2.7;
  double maximum_range = 80.0;
  double lowest = -20.0;
  double highest = 20.0;
  double ray_range = 80.0;
  double ray_lowest = -10.0;
  double ray_highest = 10.0;
  // Free space.
  int counts_to_free = 6;
  int counts_to_revert = 20;
  Neighbours conservative_neighbours = Neighbours::k26;
  Neighbours aggressive_neighbours = Neighbours::k124;
  // Raycast enhancement.
  bool enhancement = true;
  bool view_of_sensor = true;
  double view_width = 360.0;
  double view_top = 2.0;
  double view_bottom = -24.8;
  int image_rows = 64;
  double image_minimum = 0.2;
  double image_maximum = 80.0;
  double depth_margin = 0.2;
  int inpainting_radius = 3;
  int hole_area = 0;
  int top_margin = 0;
  // As the public program does it.
  bool public_second_round = true;
  bool public_revert = true;
  bool public_full_blocks = true;
  bool public_inpainting = true;

  /// Edge of a voxel, metres.
  [[nodiscard]] double voxel_size() const { return sub_voxel_size * sub_voxels; }
};

/// The one place where names, units, ranges and sources of the parameters stand.
const ParameterTable<Parameters>& parameter_table();

}  // namespace raymoval::freedom_method
