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

/// What a return from beyond the largest range says.
enum class FarReturns {
  kNothing,
  kImage,   ///< That the way is free, in blocks that nearer returns touch.
  kBlocks,  ///< The same, and its ray touches blocks too.
};

/// The range between four pixels of the range image.
enum class Interpolation {
  kAdaptive,  ///< Their mean, or the nearest one if that is nearer by half the truncation.
  kMean,
};

/// What one scan weighs in a voxel's mean distance.
enum class Weights {
  kRays,      ///< As many as rays go through the voxel.
  kConstant,  ///< 1.
};

/// What voxels were before the scan that makes their block.
enum class NewVoxels {
  kFree,      ///< Never occupied.
  kOccupied,  ///< Occupied in that scan.
};

/// Which points may be in clusters and make voxels occupied.
enum class Judged {
  kAll,
  kWithin,  ///< Those from the least to the largest range.
};

/// What the extent of a cluster is the diagonal of.
enum class Extents {
  kVoxels,  ///< The box around its voxels.
  kPoints,  ///< The box around its points.
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
  FarReturns clearing = FarReturns::kImage;
  Interpolation interpolation = Interpolation::kAdaptive;
  Weights weights = Weights::kRays;
  // What is ever free.
  Judged judged = Judged::kAll;
  NewVoxels new_voxels = NewVoxels::kFree;
  double occupied_below = 0.3;
  int temporal_buffer = 2;
  int burn_in = 5;
  int frames_to_reset = 150;
  Neighbours free_neighbours = Neighbours::kCorners;
  // Clusters.
  Neighbours cluster_neighbours = Neighbours::kFaces;
  bool grow_twice = false;
  double separation = 0.2;
  int min_points = 20;
  int max_points = 200000;
  Extents extents = Extents::kVoxels;
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
  bool public_reset = false;
};

/// The one place where names, units, ranges and sources of the parameters stand.
const ParameterTable<Parameters>& parameter_table();

}  // namespace raymoval::dynablox_method
