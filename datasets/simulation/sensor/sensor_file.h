// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/files/fields.h"
#include "core/scan/sensor_model.h"

namespace raymoval::simulated {

/// One laser shot of a sweep.
struct Shot {
  Eigen::Vector3d direction;  ///< Unit, sensor frame.
  double time_s;              ///< Since the reference time of the sweep.
};

/// A sensor file. Angles are radians here and degrees in the file (keys end in _deg).
struct SensorFile {
  enum class Kind {
    kSpinning,  ///< Beams at fixed elevations turn about z.
    kRaster,    ///< Rows and columns of a limited field of view: a solid-state LiDAR.
    kRosette,   ///< Two rotating prisms, non-repetitive (Livox).
  };
  std::string name;
  std::string description;
  Kind kind = Kind::kSpinning;
  std::vector<double> elevations;  ///< Spinning: of each beam, top first.
  double azimuth_step = 0.0;       ///< Spinning.
  NumberRange azimuth, elevation;  ///< Raster: the field of view.
  int columns = 0, rows = 0;       ///< Raster.
  int points = 0;                  ///< Rosette: shots per sweep.
  double half_angle = 0.0;         ///< Rosette: of its cone.
  std::pair<double, double> prism_hz;
  double period_s = 0.1;
  NumberRange range_m{0.9, 80.0};
  double noise_m = 0.02;         ///< Standard deviation of a range.
  double direction_noise = 0.0;  ///< Of a direction, radians.
  double divergence = 0.0;       ///< Full angle of a beam, radians.
  double pulse_m = 0.5;          ///< Surfaces nearer to each other than this give one return.
  double dropout = 0.0;          ///< Share of shots that are lost at random.
  /// Range at which half the shots at a dark (10 %) target return, at a right angle.
  double range_at_10_percent_m = 80.0;

  /// Shots of sweep `scan`, in the order of its points (beam after beam for a spinning sensor).
  /// The phase of a spinning sensor drifts from sweep to sweep, depending on `seed`.
  [[nodiscard]] std::vector<Shot> shots(std::size_t scan, std::uint64_t seed) const;
  /// The sensor model for methods.
  [[nodiscard]] SensorModel model() const;
};

/// @param file its path for messages; the stem is the name of the sensor
/// @throws ConfigurationError naming the place in the file, what is wrong and what was expected.
SensorFile sensor_from_json(const nlohmann::json& json, const std::string& file);

}  // namespace raymoval::simulated
