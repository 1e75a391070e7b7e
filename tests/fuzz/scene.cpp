// SPDX-License-Identifier: MIT
#include "datasets/simulated/scene_text.h"

#include "tests/fuzz/target.h"

namespace {

using namespace raymoval;

void try_scene(std::string_view bytes) {
  const std::string text(bytes);
  (void)names_scene(text);
  fuzz::may_refuse([&] {
    const SimulationOptions options = parse_scene(text);
    fuzz::require(options.scene.size() <= text.size(), "a scene's name grows");
    fuzz::require(options.pose_noise >= 0.0, "pose noise is below zero");
  });
}

}  // namespace

RAYMOVAL_FUZZ_TARGET(scene, try_scene)
