// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/raymoval_plus.h"

namespace raymoval {

MethodEntry raymoval_plus_entry() {
  MethodEntry entry;
  entry.name = "raymoval_plus";
  entry.sentence =
      "Terrain, three-way evidence of every scan on every voxel, a vote, objects and tracks.";
  entry.source = "this project";
  entry.version = "17";
  entry.confidence = {
      "What was decided on a point, the evidence of its voxel, and the dynamic share of its "
      "object.",
      // scripts/calibrate.cpp over ten simulated worlds, odd seeds, five sensors; EXPERIMENTS.md.
      {{0.0000F, 0.0068F},
       {0.0198F, 0.0311F},
       {0.0582F, 0.0676F},
       {0.1335F, 0.1097F},
       {0.4972F, 0.2944F},
       {0.5165F, 0.5235F},
       {0.6293F, 0.7795F},
       {0.7238F, 0.8925F},
       {0.8222F, 0.9298F},
       {0.8796F, 0.9522F},
       {0.9200F, 0.9720F},
       {0.9453F, 0.9874F},
       {0.9691F, 0.9957F},
       {0.9844F, 0.9992F}}};
  entry.variants = {
      {"offline", "Every point answered from all scans.", false, {}},
      {"online", "Each scan answered when it comes.", true, {{"at_once", true}}},
      {"online-lag",
       "Each scan answered once, a second after it came (delay), from the scans up to then.",
       true,
       {{"at_once", true}, {"delay", 1.0}}},
      {"online-map",
       "One pass as the scans come, every point answered by the map as it is in the end.",
       false,
       {{"one_pass", true}}},
  };
  entry.bind(raymoval_plus_method::parameter_table(), raymoval_plus_method::make_raymoval_plus);
  return entry;
}

}  // namespace raymoval
