// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/raymoval_plus.h"

namespace raymoval {

MethodEntry raymoval_plus_entry() {
  MethodEntry entry;
  entry.name = "raymoval_plus";
  entry.sentence =
      "Terrain, three-way evidence of every scan on every voxel, a vote, objects and tracks.";
  entry.source = "this project";
  entry.version = "6";
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
