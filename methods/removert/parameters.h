// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/parameters.h"

namespace raymoval::removert_method {

enum class DifferenceRule {
  kSigned,    ///< Only map points in front of the scan's return are dynamic.
  kAbsolute,  ///< Map points behind it too, as the public code does.
};

enum class DecisionRule {
  kAny,    ///< One scan that sees through a map point removes it.
  kScore,  ///< Weighed counts of scans for and against.
};

/// See `parameter_table` for units, ranges and sources. A resolution of 0 leaves its pass
/// out.
struct Parameters {
  double remove_resolution_1 = 2.5;
  double remove_resolution_2 = 2.2;
  double remove_resolution_3 = 2.0;
  double remove_resolution_4 = 0.0;
  double revert_resolution_1 = 0.0;
  double revert_resolution_2 = 0.0;
  double revert_resolution_3 = 0.0;
  double revert_resolution_4 = 0.0;

  double gamma = 0.05;
  double tau_abs = 0.0;
  double diff_upper = 200.0;
  DifferenceRule difference = DifferenceRule::kSigned;

  double vertical_fov = 50.0;
  double horizontal_fov = 360.0;
  bool clamp_fov = false;
  bool wrap_azimuth = true;
  bool world_axes = false;

  DecisionRule decision = DecisionRule::kAny;
  double static_weight = 0.3;
  double dynamic_weight = 0.7;
  double static_score = -0.1;
  bool update_between_passes = true;
  bool revert_needs_view = false;

  double map_voxel = 0.05;
  double scan_voxel = 0.0;
  int keyframe_gap = 1;
  int batch_scans = 0;

  bool scan_side = false;
  int scan_side_neighbours = 2;
  double scan_side_threshold = 0.1;

  /// Resolutions above 0 in pixels per degree, in order.
  [[nodiscard]] std::vector<double> remove_resolutions() const;
  [[nodiscard]] std::vector<double> revert_resolutions() const;
};

const ParameterTable<Parameters>& parameter_table();

}  // namespace raymoval::removert_method
