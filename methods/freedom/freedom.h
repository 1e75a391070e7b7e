// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/method_entry.h"

namespace raymoval {
namespace freedom_method {

/// Parameters of FreeDOM; defaults are those of its public program for KITTI. Units, ranges and
/// meanings are in entry.cpp.
struct Parameters {
  double sub_voxel_size = 0.1;
  // The points of a scan, and its rays.
  double minimum_range = 2.7;
  double maximum_range = 80.0;
  double lowest = -20.0;
  double highest = 20.0;
  double ray_range = 80.0;
  double ray_lowest = -10.0;
  double ray_highest = 10.0;
  // Free space.
  int counts_to_free = 6;
  int counts_to_revert = 20;
  // Raycast enhancement.
  bool enhancement = true;
  double image_maximum = 80.0;

  /// Edge of a voxel, metres.
  [[nodiscard]] double voxel_size() const { return sub_voxel_size * 4; }
};

/// C. Li et al.: "FreeDOM: Online Dynamic Object Removal Framework for Static Map Construction
/// Based on Conservative Free Space Estimation", RA-L 2025. Voxels (0.4 m) are free or not;
/// sub-voxels (0.1 m) keep one point each, with its scan and a level. Per scan:
///  1. Scan map: the points in range in voxels.
///  2. Scan removal: points in free space are conservative, and levels grow around them in the
///     scan. Free space that several scans hit without a pass in between is no longer free.
///  3. Raycast enhancement: ends of rays without a return, where a hole of the depth image is open
///     to the top.
///  4. Free space: the passes of rays through voxels are counted. A voxel is free if it and its
///     neighbours were passed often enough.
///  5. Map removal: points in newly free voxels are conservative, and levels grow around them to
///     points of the same scan.
///  6. Integration: a point is stored in its sub-voxel unless that has a point of the same or a
///     lower level.
///  7. The map is the static sub-voxels after the last scan; points in other sub-voxels are
///     removed.
/// Decisions and deviations from the public program: `notes` of the entry.
std::unique_ptr<Remover> make_freedom(const Parameters& parameters);

}  // namespace freedom_method

MethodEntry freedom_entry();

}  // namespace raymoval
