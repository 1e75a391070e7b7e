// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/stage_timer.h"
#include "methods/raymoval/scan_against_map.h"

namespace raymoval::raymoval_method {

/// Map voxels that a scan contradicts.
struct Evidence {
  std::vector<VoxelIndex> seen_through, without_return;
};

/// Finds the voxels to erase: those a scan sees through (the erase cases of Fig. 1), and those it
/// has no return from in several scans (the no-return evidence of the runtime table).
class EvidenceFinder {
 public:
  /// @param parameters and `sensor` must outlive this
  EvidenceFinder(const Parameters& parameters, const SensorModel& sensor, const AngularGrid& grid);

  /// Both kinds of evidence are read off the same map before any of it is erased.
  /// @param scan with its references found
  Evidence find(const ScanAgainstMap& scan, const OccupancyMap& map, int threads,
                StageTimes* times);

 private:
  std::vector<VoxelIndex> voxels_seen_through(const ScanAgainstMap& scan, const OccupancyMap& map,
                                              int threads);
  void drop_own_voxels(const ScanAgainstMap& scan, const OccupancyMap& map,
                       std::vector<VoxelIndex>& voxels);
  std::vector<VoxelIndex> voxels_without_return(const ScanAgainstMap& scan, const OccupancyMap& map,
                                                int threads);

  const Parameters& parameters_;
  const SensorModel& sensor_;
  int erase_rows_;
  VoxelMap<int> scans_without_return_;
  // These belong to the scan at hand and are kept for their memory.
  std::vector<std::uint32_t> number_of_;  ///< Of each brick: its number in `bricks` plus one, or 0
                                          ///< if no ray passes through it in this scan.
  std::vector<float> nearest_return_;
};

}  // namespace raymoval::raymoval_method
