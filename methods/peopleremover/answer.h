// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/scan/scan.h"
#include "methods/peopleremover/lattice_scan.h"
#include "methods/peopleremover/traversal.h"

namespace raymoval::peopleremover_method {

/// Steps 2.9 and 2.10: the verdicts of a scan from the final freed voxels. Each thread needs one of
/// its own.
///
/// half(x) need not be stored: a point of scan i in voxel x is in it iff scan i has a point in a
/// freed voxel near x, which the scan's own points tell.
class ScanVerdicts {
 public:
  /// @param freed one word per brick of `map`
  /// @param half_voxel_radius voxels (Chebyshev); 0 removes freed voxels only
  ScanVerdicts(const BrickMap& map, const std::vector<BrickWord>& freed, int half_voxel_radius)
      : freed_(freed),
        radius_(half_voxel_radius),
        finder_(map),
        own_freed_(map.size()),
        halo_(map.size()) {}

  /// @param scan_points points of the whole scan, those left out included, which stay static
  Mask of(const LatticeScan& scan, std::size_t scan_points);

 private:
  const std::vector<BrickWord>& freed_;
  int radius_;
  BrickFinder finder_;
  VoxelMarks own_freed_;  ///< Freed voxels in which the scan has a point.
  VoxelMarks halo_;       ///< These voxels and all voxels near them.
};

}  // namespace raymoval::peopleremover_method
