// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/method_entry.h"

namespace raymoval {
namespace hmm_mos_method {

/// Parameters of HMM-MOS; defaults are those of its public program's configurations. Units, ranges
/// and meanings are in entry.cpp.
struct Parameters {
  // The used points of a scan.
  double voxel_size = 0.25;
  double min_range = 0.5;
  double max_range = 50.0;
  // The state of a voxel.
  double spread = 1.0;
  double transition = 0.005;
  double belief = 0.99;
  // Forgetting.
  int map_scans = 300;
  double map_range_factor = 1.5;
  // Change.
  int reach = 2;
  int window_scans = 5;
  double least_threshold = 3.0;
  // Behaviour of the public program.
  bool public_lattice = true;
  // Additions of this project.
  bool offline = false;
};

/// V. Bhandari, J. James, T. Phillips, P. R. McAree: "Moving Object Segmentation in Point Cloud
/// Data using Hidden Markov Models", IROS 2024 workshop. For each scan:
///  1. The voxels of its points are occupied.
///  2. These voxels and the voxels on the rays to them are observed.
///  3. Each observed voxel has a distance to the nearest voxel that is occupied now or was occupied
///     in the previous scan.
///  4. With this distance, a hidden Markov model of each voxel (unobserved, occupied, free) takes a
///     step. A voxel has a state if the model is sure of it.
///  5. Voxels far from the sensor, or not seen for long, are forgotten.
///  6. The score of an occupied voxel is the number of voxels in the cube around it that became
///     occupied in this scan, minus the number of unknown voxels.
///  7. The score becomes the median of the neighbours' scores; 8. scores are summed over the last
///     scans.
///  9. A threshold on the histogram of scores separates moving voxels; 10. voxels that moved in the
///     previous scan need a lower score; 11. neighbours of moving voxels move too.
///  12. Their points are removed, unless the threshold is so low that nothing moves.
/// Decisions and deviations from the public program: `notes` of the entry.
std::unique_ptr<Remover> make_hmm_mos(const Parameters& parameters);

}  // namespace hmm_mos_method

MethodEntry hmm_mos_entry();

}  // namespace raymoval
