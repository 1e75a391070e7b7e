// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <memory>

#include "methods/method_entry.h"

namespace raymoval {
namespace peopleremover_method {

/// Where a beam ends.
enum class MaxrangeMethod {
  kNone,     ///< At the point it measured.
  kNormals,  ///< Where it meets the plane that lies one voxel diagonal in front of the surface.
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
  /// Points this near, or nearer, are left out; metres.
  [[nodiscard]] double effective_minimum_range() const {
    return minimum_range > 0.0 ? minimum_range : voxel_diagonal();
  }
};

/// The Peopleremover: change detection by traversing a voxel occupancy grid (Schauer and Nuechter,
/// RA-L 3(3), 2018, and ISPRS J. 2018), written from a description of the public program (3DTK).
///
/// A voxel is freed if a beam of some scan passes through it, it holds points, and none of them is
/// of that scan (or of one within `diff` scans). Points in freed voxels are dynamic, and so are
/// points of a scan that has others in a freed voxel nearby.
///
/// Decisions, and what differs from the public program, are the `notes` of the entry.
std::unique_ptr<Remover> make_peopleremover(const Parameters& parameters);

}  // namespace peopleremover_method

MethodEntry peopleremover_entry();

}  // namespace raymoval
