// SPDX-License-Identifier: MIT
#include "core/sensor_model.h"

#include <algorithm>
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

/// `angles` sorted on return; the angle below which the share `quantile` of them lies.
double quantile_of(std::vector<double>& angles, double quantile) {
  const auto at = static_cast<std::ptrdiff_t>(quantile * static_cast<double>(angles.size() - 1));
  std::nth_element(angles.begin(), angles.begin() + at, angles.end());
  return angles[static_cast<std::size_t>(at)];
}

/// Directions, ranges and steps between consecutive points of a few scans.
struct Sample {
  std::vector<double> azimuths, elevations, azimuth_gaps;
  double nearest = 1e300, farthest = 0.0;

  void add(const Scan& scan) {
    double last_azimuth = 1e300;
    for (const Eigen::Vector3f& point : scan.points) {
      const Eigen::Vector3d p = point.cast<double>();
      const double range = p.norm();
      if (!(range > 1e-3)) continue;
      const double azimuth = std::atan2(p.y(), p.x());
      azimuths.push_back(azimuth);
      elevations.push_back(std::asin(std::clamp(p.z() / range, -1.0, 1.0)));
      const double gap = std::abs(azimuth - last_azimuth);
      if (gap > 1e-6 && gap < 0.05) azimuth_gaps.push_back(gap);
      last_azimuth = azimuth;
      nearest = std::min(nearest, range);
      farthest = std::max(farthest, range);
    }
  }
};

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

SensorModel estimate_sensor_model(const std::vector<Scan>& scans) {
  Sample sample;
  for (const Scan& scan : scans) sample.add(scan);
  if (sample.azimuths.empty()) {
    throw DataError("the sensor cannot be estimated: none of " + std::to_string(scans.size()) +
                    " sampled scans has a point. Name it with \"sensor\" in sequence.json.");
  }
  constexpr double kTail = 1e-4;
  SensorModel model;
  model.name = "estimated";
  model.azimuth_step = sample.azimuth_gaps.empty() ? 0.0 : quantile_of(sample.azimuth_gaps, 0.5);
  const double margin = std::max(model.azimuth_step, 0.2 * kDegree);
  model.elevation_min = quantile_of(sample.elevations, kTail) - margin;
  model.elevation_max = quantile_of(sample.elevations, 1.0 - kTail) + margin;
  model.azimuth_min = quantile_of(sample.azimuths, kTail) - margin;
  model.azimuth_max = quantile_of(sample.azimuths, 1.0 - kTail) + margin;
  if (model.azimuth_max - model.azimuth_min > 350.0 * kDegree) {
    model.azimuth_min = -std::numbers::pi;
    model.azimuth_max = std::numbers::pi;
  }
  model.range_min = sample.nearest;
  model.range_max = sample.farthest;
  return model;
}

}  // namespace raymoval
