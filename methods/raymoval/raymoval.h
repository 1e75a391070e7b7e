// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/method_entry.h"

namespace raymoval {
namespace raymoval_method {

/// Parameters of the paper's method. The table of entry.cpp names the parameters of the paper; the
/// others decide what the paper leaves open.
struct Parameters {
  // Angular grid (eqs 2-5).
  int azimuth_bins = 720;
  int elevation_bins = 450;
  double elevation_margin = 1.0;
  // Map and rays (eqs 6-7).
  double voxel_size = 0.2;
  double maximum_range = 60.0;
  double minimum_range = 2.7;
  // Map reference (eqs 8-9).
  int neighbourhood = 1;
  double percentile = 0.9;
  // Forward test: the scan is in front of the map (eq. 11).
  double tau0 = 0.30;
  double tau1 = 0.35;
  // Erase test: the scan sees through the map.
  double erase_tau0 = 0.30;
  double erase_tau1 = 0.10;
  double erase_percentile = 0.1;
  double erase_height = 1.0;
  double erase_height_limit = 5.0;
  int erase_azimuth_window = 1;
  int erase_elevation_window = -1;
  // Spatial consistency validation of a scan's candidates (eqs 12-15).
  bool validate = true;
  double cluster_gap = 0.3;
  double cluster_gap_growth = 0.02;
  double cluster_points = 3.0;
  double cluster_width = 0.0;
  int group_gap = 1;
  int coverage_dilation = 1;
  double coverage_static = 0.95;
  double coverage_edge = 0.9;
  double thin_side = 0.4;
  int support_dilation = 2;
  double support_share = 0.95;
  int minimum_points = 1;
  double minimum_width = 0.0;
  // Answer.
  bool offline = true;
};

/// "Raymoval: Raycasting-based Dynamic Object Removal for Static 3D Mapping".
std::unique_ptr<Remover> make_raymoval(const Parameters& parameters);

}  // namespace raymoval_method

MethodEntry raymoval_entry();

}  // namespace raymoval
