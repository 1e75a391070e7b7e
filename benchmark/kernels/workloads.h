// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/scan/scan_source.h"
#include "methods/raymoval/kernels/first_hit.h"

namespace raymoval::kernels_bench {

using namespace raymoval_method;

/// A map of a sequence and the poses images are cast from.
struct Workload {
  std::string name;
  OccupancyMap map{0.2};
  std::vector<Pose> views;
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

/// First-hit images by all designs, on each workload.
void register_image_kernels();

}  // namespace raymoval::kernels_bench
