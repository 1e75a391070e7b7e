// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/method_entry.h"

namespace raymoval {
namespace octomap_method {

/// Parameters of the octomap method. Defaults are those of liboctomap; the cell size is that of the
/// "OctoMap 0.2" rows.
struct Parameters {
  // The map.
  double resolution = 0.2;
  double prob_hit = 0.7;
  double prob_miss = 0.4;
  double clamp_min = 0.1192;
  double clamp_max = 0.971;
  double occupancy_threshold = 0.5;
  // Beams.
  double maximum_range = -1.0;
  bool kth_nonexclusive = false;
  bool cut_end_free = false;
  bool remove_unknown = false;
  // Ground plane.
  bool ground = false;
  double ground_distance = 0.04;
  double ground_angle = 0.15;
  // Noise filter.
  bool noise = false;
  int noise_neighbours = 50;
  double noise_sigma = 1.0;
};

/// Occupancy mapping after Hornung et al., "OctoMap: an efficient probabilistic 3D mapping
/// framework based on octrees" (Autonomous Robots 34, 2013), on liboctomap's own tree, used to
/// remove moving objects: a point is removed if its leaf is free after all scans are inserted.
///
/// Decisions and deviations: `notes` of the entry.
/// @throws ConfigurationError if two parameters contradict each other
std::unique_ptr<Remover> make_octomap(const Parameters& parameters);

}  // namespace octomap_method

MethodEntry octomap_entry();

}  // namespace raymoval
