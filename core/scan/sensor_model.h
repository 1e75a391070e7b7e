// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "core/scan/scan.h"

namespace raymoval {

/// The properties of the sensor. Angles in radians in the sensor frame (azimuth counter-clockwise
/// from +x about +z, elevation up from the x-y plane), ranges in metres. If the sensor spins about
/// another axis, angles are those of the frame that `turn_to_z(spin_axis)` turns; methods get their
/// scans in that frame.
struct SensorModel {
  std::string name = "unknown";
  /// Unit vector of the frame of the points. +z for a sensor that does not spin. Known sensors have
  /// +z, since their data sheets do not tell how the points are stored.
  Eigen::Vector3d spin_axis = Eigen::Vector3d::UnitZ();
  double azimuth_min = -3.14159265358979323846;
  /// Above pi if the view includes the back of the sensor frame; never more than one turn
  /// above `azimuth_min`.
  double azimuth_max = 3.14159265358979323846;
  double elevation_min = -1.57079632679489661923;
  double elevation_max = 1.57079632679489661923;
  double azimuth_step = 0.0;  ///< Between neighbouring directions of one beam; 0 = unknown.
  /// Mean between neighbouring beams; 0 = unknown. A sensor without beams has the same step both
  /// ways: the edge of the square that each direction of one scan has to itself.
  double elevation_step = 0.0;
  double range_min = 0.0;    ///< Nearest range the sensor reports.
  double range_max = 120.0;  ///< Farthest range the sensor reports.
  /// True if a direction without a return is free up to the maximum range (and the return was not
  /// lost or filtered).
  bool missing_return_is_meaningful = false;
  /// The basis of an estimate: "64 beams, 0.173 deg by 0.427 deg, view of 360 deg by 27 deg, from
  /// 5 scans with 601,234 directions". Empty for a sensor of known values.
  std::string basis = "";
  int beams = 0;  ///< By an estimate; 0 if there are none or they are unknown.

  [[nodiscard]] bool full_circle() const { return azimuth_max - azimuth_min > 6.2; }
  [[nodiscard]] bool has_beams() const { return beams > 0; }
  [[nodiscard]] bool is_estimated() const { return !basis.empty(); }
  /// Whether a direction lies in the field of view. @param azimuth radians, any turn
  [[nodiscard]] bool sees(double azimuth, double elevation) const;
};

/// Names of the sensors known to `sensor_model_named`.
std::vector<std::string> sensor_model_names();

/// The data sheet values of a known sensor.
/// @throws ConfigurationError for an unknown name; the message lists the known ones.
SensorModel sensor_model_named(const std::string& name);

/// Field of view, steps and ranges observed in `scans` (at least one with points), for any order of
/// points. The field of view lies between the outermost directions on both sides, without 0.01 % of
/// the points on either side. It may include +-pi. `find_direction_pattern` finds the steps; they
/// stay 0 (unknown) if there are too few directions. Steps and elevations that are nearly those of
/// a known sensor are replaced by its values, so that naming that sensor changes nothing. The axis
/// about which it spins is found by `find_spin_axis`; it is +z if no beams turn about that axis.
/// @throws DataError if there is no point.
SensorModel estimate_sensor_model(const std::vector<Scan>& scans);

/// Only the spin axis of `estimate_sensor_model`; +z if there is no point.
Eigen::Vector3d estimate_spin_axis(const std::vector<Scan>& scans);

}  // namespace raymoval
