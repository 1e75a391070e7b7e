// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "core/scan.h"

namespace raymoval {

/// What is known of the sensor. Angles in radians in the sensor frame (azimuth counter-clockwise
/// from +x about +z, elevation up from the x-y plane), ranges in metres.
struct SensorModel {
  std::string name = "unknown";
  double azimuth_min = -3.14159265358979323846;
  double azimuth_max = 3.14159265358979323846;
  double elevation_min = -1.57079632679489661923;
  double elevation_max = 1.57079632679489661923;
  double azimuth_step = 0.0;    ///< Between neighbouring directions of one beam; 0 = unknown.
  double elevation_step = 0.0;  ///< Mean between neighbouring beams; 0 = unknown.
  double range_min = 0.0;       ///< Nearest range the sensor reports.
  double range_max = 120.0;     ///< Farthest range the sensor reports.
  /// True where a direction without return means that nothing stood within range (as opposed to a
  /// lost or filtered return).
  bool missing_return_is_meaningful = false;

  [[nodiscard]] bool full_circle() const { return azimuth_max - azimuth_min > 6.2; }
};

/// Names of the sensors known to `sensor_model_named`.
std::vector<std::string> sensor_model_names();

/// The data sheet values of a known sensor.
/// @throws ConfigurationError for an unknown name; the message lists the known ones.
SensorModel sensor_model_named(const std::string& name);

/// Field of view, azimuth step and ranges as seen in `scans` (at least one with points); the
/// distance of the beams stays unknown (0). The field of view is the range of angles that
/// holds 99.98 % of the points, widened by one step on either side.
/// @throws DataError if there is no point to look at.
SensorModel estimate_sensor_model(const std::vector<Scan>& scans);

}  // namespace raymoval
