// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "methods/raymoval/scan_against_map.h"

namespace raymoval::raymoval_method {

/// Finds the voxels that a scan sees through, which are to be erased (the erase cases of Fig. 1).
class EvidenceFinder {
 public:
  /// @param parameters must outlive this
  EvidenceFinder(const Parameters& parameters, const SensorModel& sensor, const AngularGrid& grid);

  /// @param scan with its references found
  std::vector<VoxelIndex> find(const ScanAgainstMap& scan, const OccupancyMap& map,
                               const RunContext& context);

 private:
  void drop_own_voxels(const ScanAgainstMap& scan, const OccupancyMap& map,
                       std::vector<VoxelIndex>& voxels);

  const Parameters& parameters_;
  int erase_rows_;
  /// Of each brick: its number among those that rays pass through in this scan plus one, or 0. Kept
  /// for its memory.
  std::vector<std::uint32_t> number_of_;
};

}  // namespace raymoval::raymoval_method
