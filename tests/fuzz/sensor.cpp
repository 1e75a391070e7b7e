// SPDX-License-Identifier: MIT
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/files/files.h"
#include "datasets/simulation/sensor/sensor_file.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

namespace {

using namespace raymoval;

void try_sensor(std::string_view bytes) {
  fuzz::may_refuse([&] {
    const nlohmann::json json = read_json(fuzz::input_file("sensor.json", bytes));
    const simulated::SensorFile sensor = simulated::sensor_from_json(json, "sensor.json");
    const SensorModel model = sensor.model();
    fuzz::require(std::isfinite(model.azimuth_step) && std::isfinite(model.elevation_step) &&
                      std::isfinite(model.elevation_max) && std::isfinite(model.range_max),
                  "a sensor model is not finite");
  });
}

}  // namespace

RAYMOVAL_FUZZ_TARGET(sensor, try_sensor)
