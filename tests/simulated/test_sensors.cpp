// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "core/error.h"
#include "datasets/simulation/scene/library.h"
#include "tests/simulated/scenes.h"

using namespace raymoval;
using namespace raymoval::simulated;

TEST_CASE("every built-in sensor gives unit directions inside its model") {
  for (const std::string& name : simulated_sensor_names()) {
    INFO(name);
    const SensorFile sensor = parse_sensor(find_sensor(name));
    const SensorModel model = sensor.model();
    const double slack = 0.002;
    for (const Shot& shot : sensor.shots(3, 1)) {
      REQUIRE(std::abs(shot.direction.norm() - 1.0) < 1e-9);
      const double elevation = std::asin(shot.direction.z());
      const double azimuth = std::atan2(shot.direction.y(), shot.direction.x());
      REQUIRE(elevation >= model.elevation_min - slack);
      REQUIRE(elevation <= model.elevation_max + slack);
      REQUIRE(azimuth >= model.azimuth_min - slack);
      REQUIRE(azimuth <= model.azimuth_max + slack);
      REQUIRE(std::abs(shot.time_s) <= 0.5 * sensor.period_s + 1e-9);
    }
  }
}

TEST_CASE("a rosette draws new directions every sweep, a raster the same") {
  const auto differs = [](const std::string& name) {
    const SensorFile sensor = parse_sensor(find_sensor(name));
    const auto a = sensor.shots(0, 1);
    const auto b = sensor.shots(1, 1);
    std::size_t moved = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      moved += (a[i].direction - b[i].direction).norm() > 0.002 ? 1 : 0;
    }
    return static_cast<double>(moved) / static_cast<double>(a.size());
  };
  CHECK(differs("rosette") > 0.9);
  CHECK(differs("solid-state") == 0.0);
}

TEST_CASE("a sensor file with a mistake is refused by name") {
  const auto message = [](const std::string& text) {
    try {
      sensor_from_text(text);
    } catch (const ConfigurationError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  CHECK(message(R"({"banks": [{"from_deg": 1, "to_deg": 0, "count": 2}], "nois_m": 1})")
            .find("noise_m") != std::string::npos);
  CHECK(message(R"({"banks": []})").find("at least one beam") != std::string::npos);
  CHECK(message(R"({"kind": "spining"})").find("spinning") != std::string::npos);
  CHECK(message(R"({"elevations_deg": [0], "range_m": [5, 1]})").find("range_m") !=
        std::string::npos);
  CHECK(message(R"({"elevations_deg": [0], "period_s": "fast"})").find("a number") !=
        std::string::npos);
}
