// SPDX-License-Identifier: MIT
#pragma once

#include "core/scan/scan.h"
#include "core/scan/sensor_model.h"
#include "methods/erasor/erasor.h"
#include "methods/erasor/naive_map.h"

namespace raymoval::erasor_method {

/// T_body_sensor of a query: bins lie on its x-y plane, and heights are above that.
///
/// As published it is the sensor's own frame, lifted by `sensor_height`. One on the ground has the
/// plane of the ground around the sensor for its x-y plane, and the heading of the sensor's x axis.
/// That plane is found in the map from below the sensor outward: first its height, the median of
/// the feet of what stands there on the storey of the sensor, then its slope, in discs that grow.
/// The road below a bridge and another level of a car park are other storeys. Where the map has too
/// little ground it is level, and where it has none the sensor is `sensor_height` above it.
/// @param map that of all scans, from which queries may have taken voxels out
Pose body_frame(const Pose& T_world_sensor, const NaiveMap& map, const Parameters& parameters);

/// Whether a point is nearer than `minimum_range`: the own car. The distance is the one along the
/// x-y plane of the sensor, as published, or with the body on the ground a level one, whichever way
/// the sensor is held.
/// @param point sensor frame, metres
bool is_own_car(const Eigen::Vector3f& point, const Pose& T_world_sensor,
                const Parameters& parameters);

/// `minimum_num_pts`, or with `points_by_beams` the share of it that a sensor with beams farther
/// apart than those of the HDL-64E of the published sets leaves in a bin; at least one.
int minimum_points_of(const SensorModel& sensor, const Parameters& parameters);

}  // namespace raymoval::erasor_method
