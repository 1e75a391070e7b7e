// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/scan/scan_source.h"
#include "methods/raymoval/kernels/first_hit.h"

namespace raymoval::kernels_bench {

using namespace raymoval_method;

/// Scans held in memory.
struct HeldSequence {
  std::vector<Scan> scans;
  SensorModel sensor;
  std::size_t points = 0;  ///< Of all scans.
};

/// A map of a sequence and the poses images are cast from.
struct Workload {
  std::string name;
  std::shared_ptr<const HeldSequence> sequence;
  OccupancyMap map{0.2};
  std::vector<std::size_t> views;  ///< Scans from whose poses images are cast.
  [[nodiscard]] const Pose& pose(std::size_t view) const {
    return sequence->scans[views[view]].T_world_sensor;
  }
};

/// Directions and limits of the paper's Table 1 for the sensor of an HDL-64E.
AngularGrid paper_grid();
inline constexpr RayLimits kPaperLimits{2.7, 60.0};

/// The sequence of $RAYMOVAL_DATA, if that is set, as "drive", and a simulated one as "simulated",
/// both with the map of their static points (of every second scan, 2.7 .. 50 m). A drive with
/// labels is also added as "drive_with_trails", with a map that includes moving points. Loaded
/// once.
/// @throws raymoval::Error if one cannot be read
const std::vector<std::unique_ptr<Workload>>& workloads();

/// A map of about `voxels` voxels: ground and house fronts.
OccupancyMap city_of(std::size_t voxels);
/// Half the side of that map, metres.
double city_reach(std::size_t voxels);

/// Bytes of free memory that the system reports; 0 if it reports none.
std::size_t available_memory();

}  // namespace raymoval::kernels_bench
