// SPDX-License-Identifier: MIT
#include "core/error.h"
#include "core/text.h"
#include "datasets/simulation/scene/simulated.h"

namespace raymoval {
namespace {

SimulationOptions of(const std::string& scene, std::size_t scans = 0,
                     const std::string& sensor = "") {
  SimulationOptions options;
  options.scene = scene;
  options.scans = scans;
  options.sensor = sensor;
  return options;
}

}  // namespace

const std::vector<SimulationSuite>& simulation_suites() {
  static const std::vector<SimulationSuite> suites = {
      {"simulated",
       "The counterparts of the paper's five segments and its construction site.",
       {of("town"), of("highway"), of("country"), of("suburb"), of("crossing"), of("excavator")}},
      {"simulated-quick",
       "Three short scenes with a 16-beam sensor and the excavator's, for tests.",
       {of("town", 25, "vlp16"), of("crossing", 25, "vlp16"), of("excavator", 25)}},
      {"simulated-long", "A round of several kilometres.", {of("long")}},
  };
  return suites;
}

const SimulationSuite& simulation_suite(const std::string& name) {
  std::vector<std::string> names;
  for (const SimulationSuite& suite : simulation_suites()) {
    if (suite.name == name) return suite;
    names.push_back(suite.name);
  }
  throw UsageError("there is no simulated suite '" + name + "'." + suggestion(name, names));
}

}  // namespace raymoval
