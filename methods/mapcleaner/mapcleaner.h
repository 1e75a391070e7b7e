// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/mapcleaner/parameters.h"
#include "methods/method_entry.h"

namespace raymoval::mapcleaner_method {

/// H. Fujita et al.: "MapCleaner: Efficiently Removing Moving Objects from
/// Point Cloud Maps in Autonomous Driving Scenarios", Remote Sensing 2022, with the ground
/// segmentation of its public program.
///  1. Patchwork++ finds the ground of each scan.
///  2. The terrain: heights of ground in cells, with gaps filled, restricted to cells that are
///     reachable from below the sensors, filled again and smoothed.
///  3. Points above the terrain are candidates.
///  4. Each scan votes on the voxels of candidates around it: for voxels that it sees, and against
///     voxels that it sees through. The majority decides.
/// Decisions and deviations from the public program: `notes` of the entry.
std::unique_ptr<Remover> make_mapcleaner(const Parameters& parameters);

}  // namespace raymoval::mapcleaner_method

namespace raymoval {

MethodEntry mapcleaner_entry();

}  // namespace raymoval
