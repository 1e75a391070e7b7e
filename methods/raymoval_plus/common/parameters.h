// SPDX-License-Identifier: MIT
#pragma once

#include "core/parameters.h"

namespace raymoval::raymoval_plus_method {

/// The parameters of raymoval_plus. Their units, ranges and meanings are in
/// `parameter_table()`.
struct Parameters {
  // When to answer.
  bool at_once = false;
  bool one_pass = false;
  double delay = 0.0;
  int recent_scans = 30;
  int history_scans = 20;
  int history_step = 2;
  int terrain_period = 1;
  // Terrain.
  bool terrain = true;
  double terrain_cell = 0.4;
  double terrain_quantile = 0.05;
  double terrain_drop = 0.5;
  double terrain_slope = 0.2;
  double terrain_reach = 1.2;
  double terrain_far_slope = 0.1;
  double ground_height = 0.07;
  // Evidence.
  double voxel_size = 0.2;
  double minimum_range = 0.5;
  double evidence_range_min = 2.0;
  double evidence_range_max = 80.0;
  double azimuth_bin = 0.0;
  double elevation_bin = 0.0;
  int window_columns = 1;
  int window_rows = 2;
  double voxel_share = 0.35;
  double object_score = 0.1;
  double part_score = 0.3;
  double firm_share = 0.2;
  bool whole = false;
  bool soft = true;
  double soft_gap = 0.3;
  double sure_score = 0.4;
  double soft_times = 1.5;
  bool lasting = false;
  double agree_constant = 0.2;
  double agree_slope = 0.005;
  double occluded_constant = 0.25;
  double occluded_slope = 0.005;
  bool gaps = true;
  double gap_margin = 1.0;
  double free_constant = 1.0;
  double free_per_agree = 0.3;
  int static_agree = 2;
  int run_scans = 4;
  double run_range = 20.0;
  int height_scans = 5;
  bool ground_evidence = true;
  // Vote.
  int vote_radius = 3;
  double vote_share = 0.5;
  double vote_keep = 0.3;
  double outlast = 8.0;
  // Objects.
  bool objects = true;
  double object_height = 0.3;
  double cluster_gap = 0.3;
  double cluster_growth = 0.01;
  double object_dynamic_share = 0.3;
  double object_static_share = 0.1;
  int object_points = 3;
  int group_points = 20;
  int settled_scans = 10;
  // Tracks.
  bool tracks = true;
  double track_dynamic_share = 0.25;
  double track_slack = 1.0;
  double track_width = 15.0;
  int track_points = 4;
  // Low points.
  bool low_points = true;
};

const ParameterTable<Parameters>& parameter_table();

}  // namespace raymoval::raymoval_plus_method
