// SPDX-License-Identifier: MIT
#pragma once

#include "core/parameters.h"

namespace raymoval::raymoval_plus_method {

/// The parameters of raymoval_plus. Their units, ranges and meanings are in `parameter_table()`;
/// the constants among them are the same in every run.
struct Parameters {
  // When to answer.
  bool at_once = false;
  bool one_pass = false;
  double delay = 0.0;
  int recent_scans = 30;
  int history_scans = 20;
  // Terrain.
  bool terrain = true;
  double terrain_cell = 0.4;
  double ground_height = 0.07;
  /// Quantile of a column's heights that is its ground height.
  static constexpr double terrain_quantile = 0.05;
  /// A column this much below its neighbours' quartile is dropped; metres.
  static constexpr double terrain_drop = 0.5;
  /// Largest slope from a column to its neighbours, relative to the slope of the terrain; and over
  /// up to 22 columns.
  static constexpr double terrain_slope = 0.2, terrain_far_slope = 0.1;
  /// Distance up to which a column's ground bounds that of its neighbours, metres.
  static constexpr double terrain_reach = 1.2;
  /// Scans after which the ground is estimated again.
  static constexpr int terrain_period = 1;
  // Evidence.
  double voxel_size = 0.2;
  double minimum_range = 0.5;
  double evidence_range_min = 2.0;
  double evidence_range_max = 80.0;
  double hit_distance = 0.2;
  double pass_distance = 0.25;
  /// Increase of both distances per metre of range.
  static constexpr double distance_slope = 0.005;
  double voxel_contradiction = 0.5;
  /// Hits that a voxel needs to be static.
  static constexpr int static_hits = 2;
  // Vote.
  int vote_radius = 3;
  double vote_share = 0.5;
  /// Share of dynamic voxels below which a dynamic voxel becomes static.
  static constexpr double vote_keep = 0.3;
  // Objects.
  bool objects = true;
  double object_passes = 1.0;
  double object_contradiction = 0.2;
  int object_points = 3;
  double cluster_gap = 0.3;
  /// With fewer passes a point than this an object is static, and if many scans hit it, no track
  /// makes it dynamic.
  static constexpr double object_least_passes = 0.2;
  /// Clusters consist of points at least this high above the ground, metres.
  static constexpr double object_height = 0.3;
  /// Increase of cluster_gap per metre of range.
  static constexpr double cluster_growth = 0.01;
  // Tracks.
  bool tracks = true;
  double track_width = 15.0;
  /// Share of a track's clusters that must be dynamic.
  static constexpr double track_dynamic_share = 0.25;
  /// Factor by which scans may hit an object longer than its length and speed explain.
  static constexpr double track_slack = 1.0;
  /// Smaller clusters are not tracked.
  static constexpr int track_points = 4;
  // Points near the ground.
  bool low_points = true;
};

const ParameterTable<Parameters>& parameter_table();

}  // namespace raymoval::raymoval_plus_method
