// SPDX-License-Identifier: MIT
#include "datasets/layout.h"

#include "datasets/semantickitti/semantickitti.h"
#include "datasets/simulation/scene/library.h"
#include "datasets/simulation/scene/scene_text.h"
#include "datasets/simulation/scene/simulated.h"

namespace raymoval {
namespace {

Sequence open_scene(const std::string& path, const SequenceOptions& options,
                    const OpenContext& context) {
  return open_semantickitti(cached_simulation(parse_scene(path), default_cache_root(),
                                              context.threads, context.progress, context.cancel),
                            options, context);
}

}  // namespace

Layout scenes_layout() {
  Layout layout;
  layout.name = "scenes";
  layout.expected = "the simulated scenes of `raymoval list scenes`";
  layout.forms = {{"SCENE", "a scene of `raymoval list scenes`, simulated once and cached"},
                  {"SCENE:key=value,...",
                   "the same with scans=N, seed=N, sensor=NAME, pose_noise=F, rolling=skewed, "
                   "turned=30, tilted=20, roll=90, pitch=0, yaw=0"}};
  layout.recognise = names_scene;
  layout.open = open_scene;
  layout.scenes = SceneNames{
      simulated_scene_names,
      [](Layout::Path path) { return simulated::find_world(parse_scene(path).scene).name; },
      [](Layout::Path path) { return path.substr(0, path.find(':')) + ":seed=1"; },
      [](Layout::Path path) { return is_cached(parse_scene(path), default_cache_root()); }};
  return layout;
}

}  // namespace raymoval
