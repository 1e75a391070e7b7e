// SPDX-License-Identifier: MIT
#include "core/scan/sensor_model.h"

#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

const std::vector<SensorModel>& known_sensors() {
  // Data sheet values; azimuth steps at 10 Hz.
  static const std::vector<SensorModel> sensors = [] {
    const auto spinning = [](const char* name, double low, double high, double azimuth_step,
                             int beams, double range_min, double range_max) {
      SensorModel model;
      model.name = name;
      model.elevation_min = low * kDegree;
      model.elevation_max = high * kDegree;
      model.azimuth_step = azimuth_step * kDegree;
      model.elevation_step = (high - low) / (beams - 1) * kDegree;
      model.range_min = range_min;
      model.range_max = range_max;
      return model;
    };
    return std::vector<SensorModel>{
        spinning("hdl64e", -24.9, 2.0, 0.1728, 64, 0.9, 120.0),
        spinning("hdl32e", -30.67, 10.67, 0.1658, 32, 1.0, 100.0),
        spinning("vlp16", -15.0, 15.0, 0.2, 16, 1.0, 100.0),
        spinning("os1-128", -22.5, 22.5, 0.3516, 128, 0.3, 120.0),
    };
  }();
  return sensors;
}

}  // namespace

std::vector<std::string> sensor_model_names() {
  std::vector<std::string> names;
  for (const SensorModel& model : known_sensors()) names.push_back(model.name);
  return names;
}

SensorModel sensor_model_named(const std::string& name) {
  for (const SensorModel& model : known_sensors()) {
    if (model.name == name) return model;
  }
  throw ConfigurationError("sensor '" + name + "' is unknown." +
                           suggestion(name, sensor_model_names()));
}

bool SensorModel::sees(double azimuth, double elevation) const {
  if (!(elevation >= elevation_min && elevation <= elevation_max)) return false;
  const double from_start = azimuth - azimuth_min;
  return from_start - kTurn * std::floor(from_start / kTurn) <= azimuth_max - azimuth_min;
}

}  // namespace raymoval
