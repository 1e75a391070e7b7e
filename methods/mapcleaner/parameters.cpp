// SPDX-License-Identifier: MIT
#include "methods/mapcleaner/parameters.h"

#include <algorithm>
#include <cmath>

#include "core/angle.h"

namespace raymoval::mapcleaner_method {
namespace {

/// The ratio of a step to the published one, at least 1.
double times_farther(double step, double published) {
  return step > 0.0 ? std::max(1.0, step / published) : 1.0;
}

/// The pixel size, degrees, with which a window of `half` pixels to either side spans a step in
/// radians; at least `pixel`.
double spanning(double pixel, int half, double step) {
  return std::max(pixel, step / kDegree / (2 * half + 1));
}

/// A number of points of a bin, reduced to `share` of it; at least the points of a plane.
int fewer(int points, double share) {
  constexpr int kPointsOfAPlane = 3;
  const int left = static_cast<int>(std::lround(points * share));
  return std::min(points, std::max(kPointsOfAPlane, left));
}

}  // namespace

Parameters for_sensor(const Parameters& parameters, const SensorModel& sensor) {
  if (parameters.public_steps) return parameters;
  const SensorModel published = sensor_model_named("hdl64e");
  const double beams = times_farther(sensor.elevation_step, published.elevation_step);
  const double columns = times_farther(sensor.azimuth_step, published.azimuth_step);
  Parameters own = parameters;
  own.row_height = spanning(parameters.row_height, parameters.window_rows, sensor.elevation_step);
  own.column_width =
      spanning(parameters.column_width, parameters.window_columns, sensor.azimuth_step);
  own.bin_points = fewer(parameters.bin_points, 1.0 / (beams * columns));
  own.lowest_points = fewer(parameters.lowest_points, 1.0 / (beams * columns));
  return own;
}

}  // namespace raymoval::mapcleaner_method
