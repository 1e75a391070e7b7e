// SPDX-License-Identifier: MIT
#include "datasets/simulation/world/world.h"

#include <nlohmann/json.hpp>

#include "core/files/files.h"
#include "datasets/simulation/world/world_file.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

namespace {

using namespace raymoval;

void try_world(std::string_view bytes) {
  fuzz::may_refuse([&] {
    const nlohmann::json json = read_json(fuzz::input_file("world.json", bytes));
    const simulated::WorldFile world = simulated::world_from_json(json, "world.json");
    fuzz::require(!world.roads.empty(), "a world has no road");
  });
}

}  // namespace

RAYMOVAL_FUZZ_TARGET(world, try_world)
