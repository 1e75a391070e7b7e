// SPDX-License-Identifier: MIT
#pragma once

#include "core/parameters.h"

namespace raymoval::peopleremover_method {

/// Where a beam ends.
enum class MaxrangeMethod {
  kNone,     ///< At the point it measured.
  kNormals,  ///< Where it meets the plane that lies one voxel diagonal in front of the surface.
};

/// Parameters of the Peopleremover, named as the options of its public program (3DTK).
struct Parameters {
  double voxel_size = 0.2;
  MaxrangeMethod maxrange_method = MaxrangeMethod::kNormals;
  double fuzz = 0.0;
  int diff = 0;
  int min_cluster_size = 5;
  bool subvoxel_accuracy = true;
  int half_voxel_radius = 2;
  double minimum_range = 0.0;
  int reduce_points = 0;
  double reduce_angle = 0.02;
  int reduce_seed = 1;

  /// sqrt(3) voxel edges, metres (v_d).
  [[nodiscard]] double voxel_diagonal() const;
  /// Points this near, or nearer, are left out; metres.
  [[nodiscard]] double effective_minimum_range() const;
};

/// Names, units, legal ranges, sources and a sentence for each parameter.
const ParameterTable<Parameters>& parameter_table();

}  // namespace raymoval::peopleremover_method
