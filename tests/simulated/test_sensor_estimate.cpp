// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <vector>

#include "core/angle.h"
#include "core/scan/sensor_model.h"
#include "datasets/simulation/scene/simulated.h"

using namespace raymoval;

TEST_CASE("What scans show of each simulated sensor is what it is",
          "[simulated][sensor-estimate][slow]") {
  for (const std::string& name : simulated_sensor_names()) {
    SimulationOptions options;
    options.sensor = name;
    options.scans = 5;
    const auto town = make_simulated(options, 2);
    std::vector<Scan> scans;
    for (std::size_t i = 0; i < town->size(); ++i) scans.push_back(town->load(i));
    const SensorModel truth = town->sensor();
    const SensorModel seen = estimate_sensor_model(scans);
    INFO(name + ": " + seen.basis);
    CHECK(seen.azimuth_min == Approx(truth.azimuth_min).margin(kDegree));
    CHECK(seen.azimuth_max == Approx(truth.azimuth_max).margin(kDegree));
    CHECK(seen.elevation_min == Approx(truth.elevation_min).margin(kDegree));
    if (name == "rosette") {
      // Its truth is the mean spacing over the cone. Its directions crowd in the middle and at the
      // rim, and nothing returns from the sky.
      CHECK(seen.beams == 0);
      CHECK(seen.azimuth_step == Approx(truth.azimuth_step).epsilon(0.5));
      CHECK(seen.elevation_step == seen.azimuth_step);
      continue;
    }
    CHECK(seen.elevation_max == Approx(truth.elevation_max).margin(kDegree));
    CHECK(seen.azimuth_step == Approx(truth.azimuth_step).epsilon(0.05));
    CHECK(seen.elevation_step == Approx(truth.elevation_step).epsilon(0.05));
  }
}
