// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <memory>

#include "methods/method_entry.h"

namespace raymoval {
namespace peopleremover_method {

/// The end of a beam.
enum class MaxrangeMethod {
  kNone,     ///< At its point.
  kNormals,  ///< At the plane one voxel diagonal in front of the surface.
};

/// Parameters of the Peopleremover, named as the options of its public program (3DTK).
struct Parameters {
  double voxel_size = 0.2;
  MaxrangeMethod maxrange_method = MaxrangeMethod::kNormals;
  int diff = 0;
  int min_cluster_size = 5;
  bool subvoxel_accuracy = true;
  int half_voxel_radius = 2;
  double minimum_range = 0.0;

  /// sqrt(3) voxel edges, metres (v_d).
  [[nodiscard]] double voxel_diagonal() const { return std::sqrt(3.0) * voxel_size; }
  /// Points up to this range are left out; metres.
  [[nodiscard]] double effective_minimum_range() const {
    return minimum_range > 0.0 ? minimum_range : voxel_diagonal();
  }
};

/// The Peopleremover: change detection by traversing a voxel occupancy grid (Schauer and Nuechter,
/// RA-L 3(3), 2018, and ISPRS J. 2018), written from a description of the public program (3DTK).
///
/// A voxel with points is freed if a beam of some scan passes through it, and none of its points is
/// of that scan (or of a scan within `diff` scans). Points in freed voxels are dynamic, and so are
/// points of a scan that also has points in a freed voxel nearby.
///
/// Decisions and deviations from the public program: `notes` of the entry.
std::unique_ptr<Remover> make_peopleremover(const Parameters& parameters);

}  // namespace peopleremover_method

MethodEntry peopleremover_entry();

}  // namespace raymoval
