// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/method_entry.h"

namespace raymoval {
namespace hmm_mos_method {

/// Parameters of HMM-MOS; defaults are those of its public program's configurations. Their units,
/// ranges and meanings stand in entry.cpp.
struct Parameters {
  // What is taken of a scan.
  double voxel_size = 0.25;
  double min_range = 0.5;
  double max_range = 50.0;
  // The state of a voxel.
  double spread = 1.0;
  double transition = 0.005;
  double belief = 0.99;
  // What is forgotten.
  int map_scans = 300;
  double map_range_factor = 1.5;
  // What changed.
  int reach = 2;
  int window_scans = 5;
  double least_threshold = 3.0;
  // As the public program does it.
  bool public_lattice = true;
  // Ours.
  bool offline = false;
};

/// V. Bhandari, J. James, T. Phillips, P. R. McAree: "Moving Object Segmentation in Point Cloud
/// Data using Hidden Markov Models", IROS 2024 workshop. For each scan:
///  1. Its points' voxels are occupied.
///  2. Voxels on the rays to them, and they themselves, are observed.
///  3. Each observed voxel has a distance to the nearest voxel that is occupied now or was in the
///     scan before.
///  4. By it, a hidden Markov model of each voxel (unobserved, occupied, free) takes a step. The
///     state is that of which the model is sure.
///  5. What is far from the sensor, or was not seen for long, is forgotten.
///  6. An occupied voxel's score is how many of the cube around it became occupied just now, less
///     those of which nothing is known.
///  7. The median of the neighbours' scores; 8. the sum over the last scans.
///  9. A histogram's threshold parts moving voxels from the rest; 10. those of the scan before stay
///     for less; 11. their neighbours move as well.
///  12. Their points are removed, unless the threshold is so low that nothing moves.
/// Decisions and deviations from the public program: `notes` of the entry.
std::unique_ptr<Remover> make_hmm_mos(const Parameters& parameters);

}  // namespace hmm_mos_method

MethodEntry hmm_mos_entry();

}  // namespace raymoval
