// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/parameters.h"

namespace raymoval::removert_method {

enum class DifferenceRule {
  kSigned,    ///< Only map points in front of the scan's return are dynamic.
  kAbsolute,  ///< Map points behind it too, as the public code does.
};

/// See `parameter_table` for units, ranges and sources. A resolution of 0 leaves its pass
/// out.
struct Parameters {
  double remove_resolution_1 = 2.5;
  double remove_resolution_2 = 2.2;
  double remove_resolution_3 = 2.0;
  double revert_resolution_1 = 0.0;

  double gamma = 0.05;
  double diff_upper = 200.0;
  DifferenceRule difference = DifferenceRule::kSigned;

  double vertical_fov = 50.0;
  double horizontal_fov = 360.0;
  bool clamp_fov = false;
  bool wrap_azimuth = true;

  bool update_between_passes = true;

  double map_voxel = 0.05;

  /// Resolutions of the remove passes above 0 in pixels per degree, in order.
  [[nodiscard]] std::vector<double> remove_resolutions() const;
};

const ParameterTable<Parameters>& parameter_table();

}  // namespace raymoval::removert_method
