// SPDX-License-Identifier: MIT
#include "core/scan/sensor_model.h"
#include "core/angle.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "core/error.h"

using namespace raymoval;
using Catch::Matchers::Contains;

namespace {

/// Beams at -10, -9 ... 10 degrees, each with a point every half degree from `first` to `last`;
/// the beam at -10 degrees sees 10 m far, the next 11 m, the last 30 m.
Scan half_degree_scan(double first, double last) {
  Scan scan;
  for (int beam = 0; beam <= 20; ++beam) {
    const double elevation = (beam - 10) * kDegree;
    const int steps = static_cast<int>(std::lround((last - first) * 2.0));
    for (int step = 0; step <= steps; ++step) {
      const double azimuth = (first + 0.5 * step) * kDegree;
      const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                      std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      scan.points.push_back(((10.0 + beam) * direction).cast<float>());
    }
  }
  return scan;
}

}  // namespace

TEST_CASE("Known sensors have the values of their data sheets") {
  const SensorModel model = sensor_model_named("hdl64e");
  CHECK(model.name == "hdl64e");
  CHECK(model.elevation_min == Approx(-24.9 * kDegree));
  CHECK(model.elevation_max == Approx(2.0 * kDegree));
  CHECK(model.elevation_step == Approx(26.9 / 63 * kDegree));
  CHECK(model.full_circle());
  for (const std::string& name : sensor_model_names()) {
    const SensorModel known = sensor_model_named(name);
    CHECK(known.name == name);
    CHECK(known.elevation_min < known.elevation_max);
    CHECK(known.azimuth_step > 0.0);
    CHECK(known.range_min < known.range_max);
  }
}

TEST_CASE("An unknown sensor suggests the near one, or all") {
  CHECK_THROWS_AS(sensor_model_named("hdl64"), ConfigurationError);
  CHECK_THROWS_WITH(sensor_model_named("hdl64"), Contains("Did you mean 'hdl64e'?"));
  CHECK_THROWS_WITH(sensor_model_named("camera"), Contains("vlp16") && Contains("os1-128"));
}

TEST_CASE("The field of view goes from the outermost directions to those opposite") {
  // As on a data sheet, and so as that of a sensor of known values.
  const SensorModel model = estimate_sensor_model({half_degree_scan(-30.0, 30.0)});
  CHECK(model.azimuth_step == Approx(0.5 * kDegree).epsilon(1e-3));
  CHECK(model.elevation_step == Approx(1.0 * kDegree).epsilon(1e-3));
  CHECK(model.azimuth_min == Approx(-30.0 * kDegree).epsilon(1e-4));
  CHECK(model.azimuth_max == Approx(30.0 * kDegree).epsilon(1e-4));
  CHECK(model.elevation_min == Approx(-10.0 * kDegree).epsilon(1e-4));
  CHECK(model.elevation_max == Approx(10.0 * kDegree).epsilon(1e-4));
  CHECK(model.range_min == Approx(10.0));
  CHECK(model.range_max == Approx(30.0));
  CHECK_FALSE(model.full_circle());
}
