// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/method_entry.h"

namespace raymoval {
namespace removert_method {

enum class DifferenceRule {
  kSigned,    ///< Only map points in front of the scan's return are dynamic.
  kAbsolute,  ///< Map points behind it too, as in the public code.
};

/// Units, ranges and sources are in entry.cpp. A resolution of 0 skips its pass.
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
};

/// The method of "Remove, then Revert: Static Point cloud Map Construction using Multiresolution
/// Range Images" (Kim and Kim, IROS 2020), written from its description. It contains nothing of the
/// public code, whose licence forbids commercial use.
///
/// Decisions where the paper's programs differ or are unclear: `notes` of the entry. Only the map's
/// centroids are held in memory, at most about 75 bytes per cell of `map_voxel`; scans are read
/// once per pass.
std::unique_ptr<Remover> make_removert(const Parameters& parameters);

}  // namespace removert_method

MethodEntry removert_entry();

}  // namespace raymoval
