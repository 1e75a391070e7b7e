// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/method_entry.h"

namespace raymoval {
namespace dynablox_method {

/// Parameters of Dynablox; defaults are those of the published configuration. Units, ranges and
/// meanings are in entry.cpp.
struct Parameters {
  // The distance field.
  double voxel_size = 0.2;
  double min_range = 0.5;
  double max_range = 20.0;
  double truncation = 0.4;
  int max_weight = 1000;
  // Ever-free voxels.
  double occupied_below = 0.3;
  int temporal_buffer = 2;
  int burn_in = 5;
  int frames_to_reset = 150;
  // Clusters.
  double separation = 0.2;
  int min_points = 20;
  // Answer.
  bool offline = false;
};

/// L. Schmid, O. Andersson, A. Sulser, P. Pfreundschuh, R. Siegwart: "Dynablox: Real-time Detection
/// of Diverse Dynamic Objects in Complex Environments", RA-L 2023. A point moves if it appears in
/// space that was free for a while ("ever free"). For each scan in order:
///  1. Points are sorted into voxels, 2. the voxels of a scan into blocks.
///  3. Ever-free voxels with points are seeds, which grow to neighbour voxels with points.
///  4. Clusters near each other are joined.
///  5. Clusters that are too small are dropped.
///  6. Points of clusters move.
///  7. Voxels that were free for a while, like their neighbours, become ever free. Voxels that are
///     occupied for long are no longer ever free.
///  8. The scan is integrated into the distance field, which gives the free voxels.
/// Decisions and deviations from the public program: `notes` of the entry.
/// @throws ConfigurationError if the ranges are empty, or distances are truncated below the
/// threshold of occupied voxels
std::unique_ptr<Remover> make_dynablox(const Parameters& parameters);

}  // namespace dynablox_method

MethodEntry dynablox_entry();

}  // namespace raymoval
