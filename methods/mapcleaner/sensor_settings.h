// SPDX-License-Identifier: MIT
#pragma once

#include "core/scan/sensor_model.h"
#include "methods/mapcleaner/parameters.h"

namespace raymoval::mapcleaner_method {

/// The parameters for a sensor. They are set for the HDL-64E of KITTI. Unless `public_steps`, the
/// pixels for a sensor whose directions are far apart are as large as it takes for the window
/// around a voxel to reach from one direction to the next, so that there is something to compare it
/// with; and bins ask for as many points fewer as the sensor leaves there, but for no fewer than
/// span a plane. Steps that are unknown change nothing.
Parameters for_sensor(const Parameters& parameters, const SensorModel& sensor);

}  // namespace raymoval::mapcleaner_method
