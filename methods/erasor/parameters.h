// SPDX-License-Identifier: MIT
#pragma once

#include "core/parameters.h"

namespace raymoval::erasor_method {

/// What R-GPF takes as the lowest height of a bin that holds too few points to skip outliers.
enum class SparseGround {
  kLowestPoint,  ///< The height of the lowest point of the bin.
  kZero,         ///< Zero, the road below the sensor, as in the public code.
};

/// The frame in which bins lie and heights are measured, see `body_frame`.
enum class Body {
  kSensor,  ///< That of the sensor, lifted by its height, as in the public code.
  kGround,  ///< On the plane of the ground around the sensor.
};

/// Parameters of ERASOR. The table in parameters.cpp gives them the public code's names, so that
/// its configuration files carry over. The values are the general set: of the five sets that the
/// authors published in 2021 (KITTI 00, 01, 02, 05, 07) the median, which for every value is also
/// the most frequent one.
struct Parameters {
  // Body frame and naive map.
  Body body = Body::kSensor;
  double sensor_height = 1.73;
  double minimum_range = 2.7;
  double map_voxel_size = 0.2;
  // Queries.
  double query_voxel_size = 0.2;
  int removal_interval = 5;
  int phase = -1;
  // R-POD: ring by sector bins.
  double maximum_range = 80.0;
  int rings = 20;
  int sectors = 108;
  double minimum_height = -1.3;
  double maximum_height = 3.0;
  // Scan ratio test.
  int version = 3;
  double ratio_threshold = 0.2;
  int minimum_points = 6;
  bool points_by_beams = false;
  double minimum_object_height = 0.5;
  double minimum_top = 0.2;
  bool reinsert = true;
  // R-GPF.
  int lowest_skipped = 5;
  int lowest_averaged = 10;
  double seed_height = 0.5;
  int plane_iterations = 3;
  double ground_distance = 0.15;
  bool require_upright = false;
  SparseGround sparse_ground = SparseGround::kLowestPoint;
};

/// The one place where the parameters are named.
const ParameterTable<Parameters>& parameter_table();

}  // namespace raymoval::erasor_method
