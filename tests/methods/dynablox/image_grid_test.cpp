// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "core/angle.h"
#include "methods/dynablox/field.h"
#include "tests/methods/dynablox/oracle.h"

namespace raymoval::dynablox_test {
using namespace raymoval::dynablox_method;

TEST_CASE("dynablox: an arc tangent is right to 1e-6") {
  for (int i = 0; i < 720; ++i) {
    const auto x = static_cast<float>(std::cos(i * 0.5 * kDegree) * (1 + i));
    const auto y = static_cast<float>(std::sin(i * 0.5 * kDegree) * (1 + i));
    CHECK(std::abs(dynablox_test::arc_tangent(y, x) - std::atan2(y, x)) < 1e-6F);
  }
  CHECK(dynablox_test::arc_tangent(0.0F, 0.0F) == 0.0F);
}

TEST_CASE("dynablox: the image is as large as the sensor says") {
  const ImageGrid hdl64(sensor_model_named("hdl64e"));
  CHECK(hdl64.columns == 2083);
  CHECK(hdl64.rows == 64);
  const ImageGrid vlp16(sensor_model_named("vlp16"));
  CHECK(vlp16.columns == 1800);
  CHECK(vlp16.rows == 16);
  CHECK(vlp16.pixels_per_square_radian == Approx(1800 / kTurn * 16 / (30 * kDegree)));
  const ImageGrid unknown(SensorModel{});
  CHECK(unknown.columns == 2048);
  CHECK(unknown.rows == 64);
}

TEST_CASE("dynablox: the view is as published where the sensor's is unknown") {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [low, high] :
       {std::pair(0.0, 0.0), std::pair(unknown, unknown), std::pair(unknown, 0.1),
        std::pair(-0.1, unknown), std::pair(0.1, -0.1), std::pair(-9.0, 9.0)}) {
    SensorModel sensor;
    sensor.elevation_min = low;
    sensor.elevation_max = high;
    sensor.azimuth_step = unknown;
    sensor.elevation_step = unknown;
    const ImageGrid grid(sensor);
    CHECK(grid.columns == 2048);
    CHECK(grid.rows == 64);
    CHECK(grid.elevation_min == Approx(-16.61 * kDegree));
    CHECK(grid.rows_per_radian == Approx(63 / (33.22 * kDegree)));
    sensor.elevation_step = 33.22 * kDegree / 15;
    CHECK(ImageGrid(sensor).rows == 16);
  }
  SensorModel sensor;
  for (const double range : {0.0, unknown}) {
    sensor.range_max = range;
    CHECK(Integrator(Parameters{}, sensor).max_range() == 20.0);
  }
  sensor.range_max = 12.0;
  CHECK(Integrator(Parameters{}, sensor).max_range() == 12.0);
}

}  // namespace raymoval::dynablox_test
