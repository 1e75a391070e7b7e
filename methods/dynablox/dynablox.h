// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/method_entry.h"

namespace raymoval {
namespace dynablox_method {

/// Parameters of Dynablox; defaults are those of the published configuration. Their units, ranges
/// and meanings stand in entry.cpp.
struct Parameters {
  // The distance field.
  double voxel_size = 0.2;
  double min_range = 0.5;
  double max_range = 20.0;
  double truncation = 0.4;
  int max_weight = 1000;
  // What is ever free.
  double occupied_below = 0.3;
  int temporal_buffer = 2;
  int burn_in = 5;
  int frames_to_reset = 150;
  // Clusters.
  double separation = 0.2;
  int min_points = 20;
  // The answer.
  bool offline = false;
};

/// L. Schmid, O. Andersson, A. Sulser, P. Pfreundschuh, R. Siegwart: "Dynablox: Real-time Detection
/// of Diverse Dynamic Objects in Complex Environments", RA-L 2023. What moves is what appears where
/// it was ever free. Of each scan, in turn:
///  1. Points are sorted into voxels, 2. those of a scan into blocks.
///  3. Those in ever-free voxels are seeds, which grow to the voxels with points beside them.
///  4. Clusters near each other are one.
///  5. Clusters that are too small are none.
///  6. Points of clusters move.
///  7. Voxels that were free for a while, as their neighbours, become ever free; those that are
///     occupied for long cease to be.
///  8. The scan is taken into the distance field that tells which voxels are free.
/// Decisions and deviations from the public program: `notes` of the entry.
/// @throws ConfigurationError if the ranges leave nothing, or distances are cut off below what
/// counts as occupied
std::unique_ptr<Remover> make_dynablox(const Parameters& parameters);

}  // namespace dynablox_method

MethodEntry dynablox_entry();

}  // namespace raymoval
