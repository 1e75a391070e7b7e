// SPDX-License-Identifier: MIT
#pragma once

#include "core/scan/scan.h"
#include "core/scan/sensor_model.h"
#include "methods/erasor/erasor.h"
#include "methods/erasor/naive_map.h"

namespace raymoval::erasor_method {

/// T_body_sensor of a query: bins are in the x-y plane of the body frame, and heights are above it.
///
/// `Body::kSensor`, as published: the sensor frame, lifted by `sensor_height`. `Body::kGround`: the
/// x-y plane is the ground around the sensor, with the heading of the sensor's x axis. This plane
/// is found in the map, in growing discs below the sensor: first its height, the median of the
/// column feet on the storey of the sensor, then its slope. The road below a bridge and another
/// level of a car park are other storeys. If the map has too little ground, the plane is level; if
/// it has none, the sensor is `sensor_height` above it.
/// @param map of all scans, possibly without voxels that queries removed
Pose body_frame(const Pose& T_world_sensor, const NaiveMap& map, const Parameters& parameters);

/// Whether a point is nearer than `minimum_range`: the ego vehicle. The distance is in the x-y
/// plane of the sensor, as published; with `Body::kGround`, it is horizontal for any tilt of the
/// sensor.
/// @param point sensor frame, metres
bool is_ego_vehicle(const Eigen::Vector3f& point, const Pose& T_world_sensor,
                    const Parameters& parameters);

/// `minimum_num_pts`; with `points_by_beams`, less for a sensor whose beams are farther apart than
/// those of the HDL-64E of the published sets; at least one.
int minimum_points_of(const SensorModel& sensor, const Parameters& parameters);

}  // namespace raymoval::erasor_method
