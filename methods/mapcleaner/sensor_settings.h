// SPDX-License-Identifier: MIT
#pragma once

#include "core/scan/sensor_model.h"
#include "methods/mapcleaner/parameters.h"

namespace raymoval::mapcleaner_method {

/// The parameters for a sensor. They are set for the HDL-64E of KITTI. Unless `public_steps`, a
/// sensor whose directions are farther apart has pixels that are larger by as much, and bins ask
/// for as many points fewer as it leaves there, but for no fewer than span a plane. Steps that are
/// unknown change nothing.
Parameters for_sensor(const Parameters& parameters, const SensorModel& sensor);

}  // namespace raymoval::mapcleaner_method
