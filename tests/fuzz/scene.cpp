// SPDX-License-Identifier: MIT
#include "datasets/simulation/scene/scene_text.h"

#include "tests/fuzz/target.h"

namespace {

using namespace raymoval;

void try_scene(std::string_view bytes) {
  // Neither a command line nor a suite file can hold a zero byte.
  const std::string text(bytes.substr(0, bytes.find('\0')));
  (void)names_scene(text);
  fuzz::may_refuse([&] {
    const SimulationOptions options = parse_scene(text);
    fuzz::require(options.scene.size() <= text.size(), "a scene's name grows");
    fuzz::require(options.pose_noise >= 0.0, "pose noise is below zero");
  });
}

}  // namespace

RAYMOVAL_FUZZ_TARGET(scene, try_scene)
