// SPDX-License-Identifier: MIT
#pragma once

#include "core/parameters.h"

namespace raymoval::dynablox_method {

/// Where the size of the range image and its vertical field of view come from.
enum class ImageSource {
  kSensor,  ///< The sensor's model; what it does not know is as published.
  kFixed,   ///< `image_columns`, `image_rows` and `vertical_view`.
};

/// Which of the 26 voxels around a voxel are its neighbours.
enum class Neighbours {
  kFaces,    ///< 6.
  kEdges,    ///< 18.
  kCorners,  ///< 26.
};

/// Parameters of Dynablox; defaults are those of the published configuration. Their units, ranges
/// and meanings are in `parameter_table()`.
struct Parameters {
  // The distance field.
  double voxel_size = 0.2;
  double min_range = 0.5;
  double max_range = 20.0;
  double truncation = 0.4;
  int max_weight = 1000;
  ImageSource image = ImageSource::kSensor;
  int image_columns = 2048;
  int image_rows = 64;
  double vertical_view = 33.22;
  bool clearing = true;
  // What is ever free.
  double occupied_below = 0.3;
  int temporal_buffer = 2;
  int burn_in = 5;
  int frames_to_reset = 150;
  Neighbours free_neighbours = Neighbours::kCorners;
  // Clusters.
  Neighbours cluster_neighbours = Neighbours::kFaces;
  bool grow_twice = true;
  double separation = 0.2;
  int min_points = 20;
  int max_points = 200000;
  double min_extent = 0.0;
  double max_extent = 200000.0;
  // Tracks.
  int min_track = 0;
  double track_distance = 1.0;
  // The answer.
  bool offline = false;
  bool public_boxes = false;
  bool public_merges = false;
  bool public_unmapped = false;
};

/// The one place where names, units, ranges and sources of the parameters stand.
const ParameterTable<Parameters>& parameter_table();

}  // namespace raymoval::dynablox_method
