// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/method_entry.h"

namespace raymoval {
namespace erasor_method {

/// The frame of the bins and heights, see `body_frame`.
enum class Body {
  kSensor,  ///< The sensor frame, lifted by the sensor's height, as in the public code.
  kGround,  ///< On the plane of the ground around the sensor.
};

/// Parameters of ERASOR. Names in the table of entry.cpp are those of the public code, so that its
/// configuration files can be used. The values are the general set: of the five sets that the
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
  double minimum_top = 0.2;
  // R-GPF.
  int lowest_skipped = 5;
  int lowest_averaged = 10;
  double seed_height = 0.5;
  int plane_iterations = 3;
  double ground_distance = 0.15;
};

/// "ERASOR: Egocentric Ratio of Pseudo Occupancy-based Dynamic Object Removal for Static 3D Point
/// Cloud Map Building" (Lim, Hwang, Myung, RA-L 2021), written from its description.
///
/// The map of all scans is an evolving set of voxels. Each query scan divides the map around it
/// into polar bins and compares the vertical extents of map and scan in each bin. If the map is
/// much higher, the bin's map voxels above a fitted ground plane are removed, and voxels with a
/// query point are put back. A point is dynamic iff its voxel is removed at the end.
///
/// Deviations from the public program: `notes` of the entry.
/// @throws ConfigurationError if the height window is empty or the ego radius leaves no range.
std::unique_ptr<Remover> make_erasor(const Parameters& parameters);

}  // namespace erasor_method

MethodEntry erasor_entry();

}  // namespace raymoval
