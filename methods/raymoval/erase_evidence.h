// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "methods/raymoval/scan_against_map.h"

namespace raymoval::raymoval_method {

/// Finds the voxels to erase, through which a scan sees (the erase cases of Fig. 1).
class EvidenceFinder {
 public:
  /// @param parameters must outlive this
  EvidenceFinder(const Parameters& parameters, const SensorModel& sensor, const AngularGrid& grid);

  /// @param scan after `find_references`
  std::vector<VoxelIndex> find(const ScanAgainstMap& scan, const OccupancyMap& map,
                               const RunContext& context);

 private:
  void drop_own_voxels(const ScanAgainstMap& scan, const OccupancyMap& map,
                       std::vector<VoxelIndex>& voxels);

  const Parameters& parameters_;
  int erase_rows_;
  /// By brick: its number plus one among the bricks of the voxels in question, or 0. Kept for its
  /// memory.
  std::vector<std::uint32_t> number_of_;
};

}  // namespace raymoval::raymoval_method
